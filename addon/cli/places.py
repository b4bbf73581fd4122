# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files are read and written, by their names."""

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

FORMATS = ("obj", "ply", "stl")
CAD_FORMATS = ("step", "stp")  # outputs only
# inputs only: Blender's importers of these turn axes; and tables of offsets
MORE_INPUTS = ("blend", "csv", "glb", "gltf", "tsv", "usd", "usda", "usdc", "usdz")


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "input",
        metavar="IN",
        type=Path,
        help="an OBJ, PLY or STL file; also .blend, glTF and USD, as Blender imports them, and a table of offsets (CSV)",
    )
    parser.add_argument(
        "output",
        metavar="OUT",
        type=Path,
        help="a file, whose name says its type. Missing folders are created, and an existing file is overwritten, but not "
        "the input",
    )


def check_places(source: Path, target: Path) -> None:
    """Raises ValueError for unknown formats, and an output that is the input."""
    require_format(source, (*FORMATS, *MORE_INPUTS))
    require_format(target, (*FORMATS, *CAD_FORMATS))
    if _same(source, target):
        raise ValueError(f"{target} is the input, and will not be overwritten")


def file_format(path: Path) -> str:
    """`obj`, `ply`, `stl`, `step` and so on, from the name alone."""
    return path.suffix.lower().removeprefix(".")


def is_cad(path: Path) -> bool:
    """Whether spline patches are written to this file."""
    return file_format(path) in CAD_FORMATS


def require_format(path: Path, formats: Sequence[str] = FORMATS) -> None:
    if file_format(path) not in formats:
        known = ", ".join(name.upper() for name in formats if name != "stp")
        raise ValueError(f"{path} is of no known type; the known types are {known}")


def _same(one: Path, other: Path) -> bool:
    """Whether two paths are one file: through links, and where the file system ignores case."""
    try:
        return os.path.realpath(one) == os.path.realpath(other) or one.samefile(other)
    except OSError:  # one of them does not exist
        return False
