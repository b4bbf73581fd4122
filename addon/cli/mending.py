# SPDX-License-Identifier: GPL-3.0-or-later
"""`--fill` and `--clean`, which replace fairing, and the options that they exclude."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..settings import NAMES
from . import clean, fill
from .places import Place, is_cad
from .rna import OfOperator, option

_OF_BOTH = OfOperator("object.fairing_fill", {}, largest_hole="largest")
_MODULES: dict[str, Any] = {"fill": fill, "clean": clean}


@dataclass(frozen=True)
class Mending:
    """One of the two: its `module`, and its options, also as they were `said`."""

    module: Any
    options: Any
    said: dict[str, Any]


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("holes, of --fill and --clean")
    _OF_BOTH.add(group)
    fill.add_options(parser)
    clean.add_options(parser)


def asked_of(arguments: argparse.Namespace, files: Sequence[Place]) -> Mending | None:
    """The requested one; None if meshes are faired. Raises ValueError for contradictory options."""
    names = [name for name in _MODULES if getattr(arguments, name)]
    if len(names) > 1:
        raise ValueError("give one of --fill and --clean: cleaning fills holes, too")
    name = names[0] if names else ""
    for each, module in _MODULES.items():
        for given in module.OPTIONS.names:
            if name != each and getattr(arguments, given) is not None:
                raise ValueError(f"{option(given)} needs --{each}")
    if not name:
        if arguments.largest_hole is not None:
            raise ValueError("--largest-hole needs --fill or --clean")
        return None
    kept = ("energy",) if name == "fill" else ()
    found = [key for key in vars(arguments) if key in NAMES and key not in ("weld", *kept)]
    if arguments.weld is not None:
        found.append("weld")
    if found:
        raise ValueError(
            f"{option(found[0])} is for fairing, and --{name} does not fair: call twice"
        )
    if any(is_cad(file.target) for file in files):
        raise ValueError(f"--{name} writes meshes: OUT cannot be a STEP file")
    module = _MODULES[name]
    said = _OF_BOTH.said(arguments) | module.OPTIONS.said(arguments)
    if name == "fill":
        said["energy"] = getattr(arguments, "energy", "TOTAL_CURVATURE")
    return Mending(module, module.options_of(said), said)
