# SPDX-License-Identifier: GPL-3.0-or-later
"""`--clean` on the command line: its options, the run, and the entries of the report."""

import argparse
from math import isfinite
from typing import Any

from ..blender import Object, current_context
from ..cleaning import STEPS, CleanJob, CleanOptions
from .report import counts
from .rna import OfOperator

_NAMES = [name for name, *_ in STEPS if name != "noise"]
OPTIONS = OfOperator(
    "object.fairing_clean", {"clean_without": ()}, clean_islands="islands", clean_noise="noise"
)


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("scans")
    group.add_argument(
        "--clean",
        action="store_true",
        help="make a closed surface of each mesh instead of fairing it: remove loose parts, mend defects, "
        "fill holes [off]",
    )
    group.add_argument(
        "--clean-without",
        action="append",
        choices=_NAMES,
        metavar="STEP",
        help=f"leave out a step; may be repeated: {', '.join(_NAMES)} [none]",
    )
    OPTIONS.add(group)


def options_of(said: dict[str, Any]) -> CleanOptions:
    steps = {name: name not in said["clean_without"] for name in _NAMES}
    steps["noise"] = said["clean_noise"]
    return CleanOptions(steps, said["clean_islands"], said["largest_hole"])


def run(source: Object, options: CleanOptions, **watchers: Any) -> tuple[dict[str, Any], list[str]]:
    """Cleans an object's mesh; returns its entry for the report, and the remaining defects."""
    entry: dict[str, Any] = {"name": source.name, "control": counts(source.data)}
    job = CleanJob(current_context(), source, options)
    job.compute(**watchers)
    said, found = job.apply(current_context()), job.result
    entry["result"] = counts(source.data)
    entry["report"] = {
        "done": [{"step": act.step, "count": act.count, "text": act.text} for act in found.done],
        "watertight": found.watertight,
        "volume": found.volume if isfinite(found.volume) else None,
        "left": [{"code": d.code, "count": len(d.elements)} for d in found.left],
        "said": said,
    }
    good = found.watertight and not found.left
    return entry, [] if good else [f"{source.name}: {said[-1]}."]
