# SPDX-License-Identifier: GPL-3.0-or-later
"""What is done with meshes instead of fairing: `--fill` or `--clean`, and what goes with which."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from ..settings import NAMES
from . import clean, fill
from .numbers import number
from .places import Place, is_cad

_OTHERS = ("pieces", "weld")  # that mean nothing here, beside settings
_OF_BOTH: dict[str, Any] = {"largest_hole": 0.0}
_MODULES: dict[str, Any] = {"fill": fill, "clean": clean}

_WIDTH = number("a length, 0 or more", lambda value: 0.0 <= value < inf)


@dataclass(frozen=True)
class Mending:
    """One of them: the `module` that knows its words, and what it is asked for."""

    module: Any
    options: Any


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("holes, of --fill and --clean")
    group.add_argument(
        "--largest-hole",
        type=_WIDTH,
        metavar="LENGTH",
        help="holes wider than this between two vertices of the rim stay open, in the file's unit; 0: only the "
        f"borders of sheets stay open [{_OF_BOTH['largest_hole']:g}]",
    )
    fill.add_options(parser)
    clean.add_options(parser)


def asked_of(arguments: argparse.Namespace, files: Sequence[Place]) -> Mending | None:
    """What is asked for; None where meshes are faired. Raises ValueError where options contradict."""
    names = [name for name in _MODULES if getattr(arguments, name)]
    if len(names) > 1:
        raise ValueError("give one of --fill and --clean: cleaning fills holes, too")
    name = names[0] if names else ""
    for each, module in _MODULES.items():
        for given in module.DEFAULTS:
            if name != each and getattr(arguments, given) is not None:
                raise ValueError(f"{_option(given)} needs --{each}")
    if not name:
        if arguments.largest_hole is not None:
            raise ValueError("--largest-hole needs --fill or --clean")
        return None
    kept = ("energy",) if name == "fill" else ()
    found = [key for key in vars(arguments) if key in NAMES and key not in (*_OTHERS, *kept)]
    found += [key for key in _OTHERS if getattr(arguments, key) is not None]
    if found:
        raise ValueError(
            f"{_option(found[0])} is for fairing, and --{name} does not fair: call twice"
        )
    if any(is_cad(file.target) for file in files):
        raise ValueError(f"--{name} writes meshes: OUT cannot be a STEP file")
    defaults = _MODULES[name].DEFAULTS | _OF_BOTH
    said = {
        key: value if (value := getattr(arguments, key)) is not None else default
        for key, default in defaults.items()
    }
    said["energy"] = getattr(arguments, "energy", fill.ENERGY)
    return Mending(_MODULES[name], _MODULES[name].options_of(said))


def _option(name: str) -> str:
    return "--" + name.removeprefix("use_").replace("_", "-")
