# SPDX-License-Identifier: GPL-3.0-or-later
"""`--fill` on the command line: its options, the run, and the entries of the report."""

import argparse
from typing import Any

from ..blender import Object, current_context
from ..errors import JobError
from ..holes import LARGER_HOLES, NO_HOLE, FillOptions, HoleJob, fill_warnings
from .report import counts
from .rna import OfOperator

OPTIONS = OfOperator(
    "object.fairing_fill",
    {},
    fill_joint="joint",
    fill_density="density",
    fill_noisy="noisy",
    fill_quads="quads",
)


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("holes")
    group.add_argument(
        "--fill",
        action="store_true",
        help="fill the holes of each mesh instead of fairing it; of the settings only --energy is used "
        "then [off; energy: total_curvature]",
    )
    OPTIONS.add(group)


def options_of(said: dict[str, Any]) -> FillOptions:
    return FillOptions(
        said["fill_joint"],
        said["energy"],
        said["fill_density"],
        said["largest_hole"],
        False,
        said["fill_noisy"],
        said["fill_quads"],
    )


def run(source: Object, options: FillOptions, **watchers: Any) -> tuple[dict[str, Any], list[str]]:
    """Fills an object's holes, if any; returns its entry and warnings. JobError if none can be."""
    entry: dict[str, Any] = {"name": source.name, "control": counts(source.data)}
    try:
        job = HoleJob(current_context(), source, options)
    except JobError as error:
        if error.code not in (NO_HOLE, LARGER_HOLES):
            raise
        said = [f"{error}."] if error.code == NO_HOLE else []
        return entry | {"result": entry["control"], "report": {"holes": []}}, said
    job.compute(**watchers)
    if job.error is not None:
        raise job.error
    job.apply()
    holes = [
        {
            "edges": [len(loop) for loop in hole.loops],
            "faces": len(hole.faces),
            "energy": hole.energy,
            "converged": hole.converged,
            "folds": hole.folds,
            "crossings": hole.crossings,
            "why_triangles": hole.why_triangles,
        }
        for hole in job.result.holes
    ]
    entry |= {"result": counts(source.data), "report": {"holes": holes}}
    said = [job.left_text, *fill_warnings([job])]
    return entry, [f"{source.name}: {sentence}." for sentence in said if sentence]
