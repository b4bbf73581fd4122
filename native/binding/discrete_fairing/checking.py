# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a mesh, without a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, vertex_array


@dataclass(frozen=True, slots=True)
class Defect:
    """One kind of thing that is wrong with a mesh, with all elements concerned.

    code: as FairingError.code. message: for a person. kind: "vertex", "edge", "face" or "mesh", what the elements are;
    edges are pairs (a, b) of vertices, a mesh has none. severity: "error" stops a run, "warning" does not.
    repair: "orientation" where `fair(..., repair_orientation=True)` mends it, else None.
    """

    code: str
    message: str
    elements: list[int] | list[tuple[int, int]]
    kind: str
    severity: str
    repair: str | None


def check(
    vertices: ArrayLike, faces: ArrayLike | Sequence[Sequence[int]], repair_orientation: bool = False
) -> list[Defect]:
    """Every kind of defect of a mesh, in the order in which `fair` would meet them; empty: nothing is wrong.

    Tests that earlier defects leave without a meaning are left out: an index out of range ends the search. With
    `repair_orientation` inconsistent orientation counts as a warning. Raises FairingError BAD_SHAPE for what are no
    arrays of vertices and faces, and nothing else.
    """
    corners, offsets = face_arrays(faces)
    found = _native.check(vertex_array(vertices), corners, offsets, bool(repair_orientation))
    return [Defect(**defect) for defect in found]


def repair_orientation(vertices: ArrayLike, faces: ArrayLike | Sequence[Sequence[int]]) -> np.ndarray:
    """Ids (f,) of the faces to reverse for all neighbours to agree: the fewer ones of each component.

    Raises FairingError where there is no answer: NON_ORIENTABLE, NONMANIFOLD_EDGE, or arrays that make no faces.
    """
    corners, offsets = face_arrays(faces)
    return _native.faces_to_flip(vertex_array(vertices), corners, offsets)
