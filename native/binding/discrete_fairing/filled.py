# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh whose holes are closed, and what is told of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .near_hole import MeshPart
from .rounds import Filling


@dataclass(frozen=True, slots=True)
class FilledHole:
    """What has become of one hole.

    loops: list of (k,) int64
        Its rim, and those of its islands.
    vertices, faces: range
        Ids of the new vertices and faces in `Filled`.
    energy: str
        The energy that was minimized; "none" where the first triangulation, spread as a membrane, was
        left as it was.
    joint: str
        What it took over at the rim.
    converged: bool
        Whether its steps came to their end; False where the triangulation stands in.
    folds: int
        Edges at which the surface turns by more than a right angle, the rim's included.
    crossings: int
        Faces of the filling that pass through others, of the mesh or of a filling.
    why_triangles: str
        Why it is no grid of quads, where one was asked for, as the end of a sentence; else empty.
    """

    loops: list[np.ndarray]
    vertices: range
    faces: range
    energy: str
    joint: str
    converged: bool
    folds: int
    crossings: int = 0
    why_triangles: str = ""


@dataclass(frozen=True, slots=True)
class Filled:
    """A mesh whose holes are closed.

    vertices: (N, 3) float64
        The n old ones first, to the last bit.
    faces: (M, 3) int64, or the pair (corners, offsets) where not all are triangles
        The m old ones first.
    new_faces: (M - m,) int64
        Ids of the new ones: triangles, or on request quads.
    holes: list of FilledHole
        What closed each hole, in the order of the holes.
    """

    vertices: np.ndarray
    faces: np.ndarray | tuple[np.ndarray, np.ndarray]
    new_faces: np.ndarray
    holes: list[FilledHole]


def put_together(
    mesh: MeshPart,
    loops: Sequence[list[np.ndarray]],
    fillings: Sequence[Filling],
    told: Sequence[tuple[int, str]],
) -> Filled:
    """The mesh with these fillings, of the holes with these loops; of each is `told` how many of its
    faces cross, and why it has no quads.
    """
    count, faces = len(mesh.points), len(mesh.offsets) - 1
    holes = []
    vertex, face = count, faces
    for rims, f, (crossings, why) in zip(loops, fillings, told, strict=True):
        by = f.made
        more, filled = range(vertex, vertex + len(f.own)), range(face, face + len(f.faces))
        found = by.energy, by.joint, by.converged, by.folds, crossings, why
        holes.append(FilledHole(rims, more, filled, *found))
        vertex, face = more.stop, filled.stop
    vertices = np.concatenate([mesh.points, *(f.own for f in fillings)])
    new = [f.faces.astype(np.int64).ravel() for f in fillings]
    corners = np.concatenate([mesh.corners, *new])
    more_sizes = [np.full(*f.faces.shape) for f in fillings]
    sizes = np.concatenate([np.diff(mesh.offsets), *more_sizes])
    if (sizes == 3).all():
        whole: Any = corners.reshape(-1, 3)
    else:
        whole = corners, np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    return Filled(vertices, whole, np.arange(faces, face), holes)
