# SPDX-License-Identifier: GPL-3.0-or-later
"""Defects of a mesh, and the size of its surface, without a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, vertex_array
from .converters import choice, switch, whole
from .errors import fairing_error


@dataclass(frozen=True, slots=True)
class Defect:
    """One kind of defect of a mesh, with all elements concerned.

    code: str
        As FairingError.code.
    message: str
        The defect and what to do about it, as text.
    elements: list
        Ids of vertices or faces, or edges as pairs (a, b) of vertices; empty for kind "mesh".
    kind: "vertex", "edge", "face" or "mesh"
        The kind of the elements.
    severity: "error" or "warning"
        An error stops a run, a warning does not.
    repairable: bool
        Whether `fair(..., repair="mend")` mends it.
    """

    code: str
    message: str
    elements: list[int] | list[tuple[int, int]]
    kind: str
    severity: str
    repairable: bool


def check(vertices: ArrayLike, faces: ArrayLike | Sequence[Sequence[int]]) -> list[Defect]:
    """Every kind of defect of a mesh, in the order in which `fair` finds them; empty if there is none.

    Skips tests that earlier defects make meaningless: an index out of range ends the search. Raises
    FairingError BAD_SHAPE, for arrays of a wrong shape or type, and OUT_OF_MEMORY.
    """
    corners, offsets = face_arrays(faces)
    found = _native.check(vertex_array(vertices), corners, offsets)
    return [Defect(**defect) for defect in found]


def predicted_size(
    vertex_count: int,
    faces: ArrayLike | Sequence[Sequence[int]],
    levels: int,
    shapes: int = 0,
    energy: str = "thin_plate",
    halved: bool = False,
) -> dict[str, int]:
    """The size of a surface and the memory of its run, without running it.

    `faces`, `levels` and `energy` are those of fair(), `vertex_count` and `shapes` are numbers.
    `halved`: the mesh will have a symmetry_plane. Returns "vertices" and "triangles" of the refined
    surface, and "bytes", a bound on the peak of the run's own arrays (with `halved`, of both halves).
    Quads that will be split count as quads. Raises FairingError BAD_SHAPE and BAD_OPTION.
    """
    count, depth, more = (
        whole(name, value)
        for name, value in (("vertex_count", vertex_count), ("levels", levels), ("shapes", shapes))
    )
    if depth > _native.most_levels:
        raise fairing_error(
            "BAD_OPTION", f"levels is {depth}; it must be from 0 to {_native.most_levels}."
        )
    functional = choice(_native.Energy.__members__)("energy", energy)
    corners, offsets = face_arrays(faces)

    def of(copies: int) -> dict[str, int]:
        every, shift = np.arange(copies)[:, None], count * np.arange(copies)[:, None]
        starts = np.append(offsets[:-1] + len(corners) * every, copies * len(corners))
        ids = (corners + shift).ravel()
        return _native.predicted_size(copies * count, ids, starts, depth, more, functional)

    size = of(1)
    return {**size, "bytes": of(2)["bytes"]} if switch("halved", halved) else size
