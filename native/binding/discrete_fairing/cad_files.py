# SPDX-License-Identifier: GPL-3.0-or-later
"""What all files for CAD share: units, parts with names and colours, and a place to write to first."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from .errors import fairing_error
from .options import real
from .patches import SplinePatches

# how many metres each has
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
_LONGEST_NAME = 40  # of a file, in the name of the temporary one


@dataclass(frozen=True)
class Part:
    """What becomes a part of its own in a file."""

    patches: SplinePatches
    name: str
    colours: np.ndarray | None  # (3,) or (P, 3) float64, red, green and blue from 0 to 1


def cad_parts(
    patches: SplinePatches | Sequence[SplinePatches],
    names: str | Sequence[str] | None,
    colours: ArrayLike | Sequence[ArrayLike | None] | None,
) -> list[Part]:
    """The parts of a file; raises FairingError BAD_OPTION where a list is too long or too short."""
    found = [patches] if isinstance(patches, SplinePatches) else list(patches)
    titles = _one_a_part("names", names, len(found), isinstance(names, str))
    single = colours is not None and isinstance(patches, SplinePatches)
    shades = _one_a_part("colours", colours, len(found), single)
    return [
        Part(own, title or f"surface {k}", _part_colours(shade, len(own)))
        for k, (own, title, shade) in enumerate(zip(found, titles, shades), 1)
    ]


def checked_scale(unit: str, scale: object) -> float:
    """`scale` as a number; raises FairingError BAD_OPTION for one that is none, or another unit."""
    if unit not in UNITS:
        raise fairing_error("BAD_OPTION", f"unit is {unit!r}; it must be {_listed(UNITS)}.")
    factor = real("scale", scale)
    if factor <= 0:
        raise fairing_error("BAD_OPTION", f"scale is {factor}; it must be greater than 0.")
    return factor


@contextmanager
def whole_file(path: str | os.PathLike) -> Iterator[Path]:
    """A name beside `path` to write to inside the `with`.

    What is written takes the place of the file at the end; after an error nothing has changed, and
    an OSError names the file itself. Whatever is no file, such as a pipe, is written to itself.
    """
    target = Path(os.path.realpath(path))  # a link stays one
    try:
        if target.exists() and not target.is_file():
            yield target
            return
        prefix = f".{target.name[:_LONGEST_NAME]}."
        handle, name = tempfile.mkstemp(prefix=prefix, suffix=".part", dir=target.parent)
        os.close(handle)
        temporary = Path(name)
        try:
            yield temporary
            _keep_mode(target, temporary)
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        if error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, os.fspath(path)) from error


def _keep_mode(target: Path, temporary: Path) -> None:
    """Temporary files are private; the new file may be read by whom an ordinary one may."""
    mask = os.umask(0)
    os.umask(mask)
    temporary.chmod(target.stat().st_mode & 0o777 if target.exists() else 0o666 & ~mask)


def _listed(names: Iterable[str]) -> str:
    return " or ".join(f'"{name}"' for name in names)


def _one_a_part(name: str, values, count: int, single: bool) -> list:
    found = [None] * count if values is None else [values] if single else list(values)
    if len(found) != count:
        raise fairing_error("BAD_OPTION", f"{name} has {len(found)} entries for {count} parts.")
    return found


def _part_colours(colours: ArrayLike | None, count: int) -> np.ndarray | None:
    if colours is None:
        return None
    array = np.asarray(colours, float)
    if array.shape not in ((3,), (count, 3)) or not ((array >= 0) & (array <= 1)).all():
        raise fairing_error(
            "BAD_OPTION",
            f"colours has shape {array.shape}; it must be (3,) or ({count}, 3), from 0 to 1.",
        )
    return array
