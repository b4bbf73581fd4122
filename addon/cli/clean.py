# SPDX-License-Identifier: GPL-3.0-or-later
"""`--clean` on the command line: its options."""

import argparse
from typing import Any

from ..jobs.clean import STEPS
from ..settings import NAMES
from .places import is_cad
from .rna import OfOperator, option

_NAMES = [name for name, *_ in STEPS if name != "noise"]
_OPTIONS = OfOperator(
    "object.fairing_clean",
    clean_islands="islands",
    clean_noise="noise",
    largest_hole="largest",
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
    _OPTIONS.add(group)


def options_of(arguments: argparse.Namespace) -> dict[str, Any] | None:
    """None if meshes are faired. Raises ValueError for contradictory options."""
    if not arguments.clean:
        _OPTIONS.refuse(arguments, "--clean", "clean_without")
        return None
    found = [name for name in NAMES if getattr(arguments, name, None) is not None]
    if found:
        raise ValueError(
            f"{option(found[0])} is for fairing, and --clean does not fair: call twice"
        )
    if is_cad(arguments.output):
        raise ValueError("--clean writes meshes: OUT cannot be a STEP file")
    said = _OPTIONS.said(arguments)
    return {
        **{name: name not in (arguments.clean_without or ()) for name in _NAMES},
        "noise": said["clean_noise"],
        "islands": said["clean_islands"],
        "largest": said["largest_hole"],
    }
