# SPDX-License-Identifier: GPL-3.0-or-later
"""Input and output paths; reads and writes no file."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

FORMATS = ("obj", "ply", "stl")
CAD_FORMATS = ("step", "stp")  # outputs only
# inputs only: Blender's importers of these turn axes; and tables of offsets
MORE_INPUTS = ("blend", "csv", "glb", "gltf", "tsv", "usd", "usda", "usdc", "usdz")
_NAME = "{name}"


class BadPlaces(Exception):
    """A usage error, as a sentence."""


@dataclass(frozen=True)
class Place:
    source: Path
    target: Path


def places(inputs: Sequence[str], output: str, chosen_format: str | None = None) -> list[Place]:
    """A Place for each input. Raises BadPlaces before any file is touched."""
    sources = [Path(name) for pattern in inputs for name in _expanded(pattern)]
    for source in sources:
        _supported(source, (*FORMATS, *MORE_INPUTS))
    found = [
        Place(source, _target(source, output, chosen_format, len(sources))) for source in sources
    ]
    _no_clash(found)
    return found


def file_format(path: Path) -> str:
    """`obj`, `ply`, `stl`, `step` and so on, from the name alone."""
    return Path(path).suffix.lower().removeprefix(".")


def is_cad(path: Path) -> bool:
    """Whether spline patches are written to this file."""
    return file_format(path) in CAD_FORMATS


def _expanded(name: str) -> list[str]:
    """The files that match a pattern such as `*.obj`, for systems whose shell does not expand it."""
    if not any(sign in name for sign in "*?[") or Path(name).exists():
        return [name]
    root = Path(Path(name).anchor)
    found = sorted(str(path) for path in root.glob(str(Path(name).relative_to(root.anchor))))
    if not found:
        raise BadPlaces(f"No file matches {name}.")
    return found


def _target(source: Path, output: str, chosen_format: str | None, count: int) -> Path:
    if output.endswith(("/", "\\")) or (is_there(Path(output)) and Path(output).is_dir()):
        if chosen_format is None and file_format(source) in MORE_INPUTS:
            raise BadPlaces(f"Give --format: {source} is of a type that is only read.")
        return Path(output) / f"{source.stem}.{chosen_format or file_format(source)}"
    if chosen_format:
        raise BadPlaces(f"--format is for an output folder: {output} sets the format already.")
    if count > 1 and _NAME not in output:
        raise BadPlaces(
            f"{count} inputs need a folder, with / at its end, or a name with {_NAME} as output, not {output}."
        )
    target = Path(output.replace(_NAME, source.stem))
    _supported(target, (*FORMATS, *CAD_FORMATS))
    return target


def _supported(path: Path, formats: Sequence[str] = FORMATS) -> None:
    if file_format(path) not in formats:
        known = ", ".join(name.upper() for name in formats if name != "stp")
        raise BadPlaces(f"{path} is of no known type; the known types are {known}.")


def no_report_over(report: str | None, found: Sequence[Place]) -> None:
    """Raises BadPlaces if the report would overwrite an input, an output or their materials."""
    if report is None or report == "-":
        return
    for place in found:
        for role, path in (("an input", place.source), ("an output", place.target)):
            own = [path, path.with_suffix(".mtl")] if file_format(path) == "obj" else [path]
            if any(_same(Path(report), other) for other in own):
                raise BadPlaces(f"{report} is {role}; give the report another name.")


def is_there(path: Path) -> bool:
    """Whether the file exists, as far as can be known."""
    try:
        return path.exists()
    except OSError:  # a name that is too long, or a folder without access
        return False


def _no_clash(found: list[Place]) -> None:
    taken: dict[str, Path] = {}
    for place in found:
        if any(_same(place.target, other.source) for other in found):
            raise BadPlaces(f"{place.target} is an input and will not be overwritten.")
        target = os.path.realpath(place.target)
        if target in taken:
            raise BadPlaces(
                f"{taken[target]} and {place.source} would both be written to {place.target}."
            )
        taken[target] = place.source


def _same(one: Path, other: Path) -> bool:
    """Whether two paths are one file: through links, and where the file system ignores case."""
    if os.path.realpath(one) == os.path.realpath(other):
        return True
    return is_there(one) and is_there(other) and one.samefile(other)
