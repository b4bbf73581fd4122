# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh whose holes are closed, and what is told of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .near_hole import MeshPart
from .rounds import Filling

_SHOWN = 8  # elements that a message lists


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
    ignored: list of int
        Faces around it that fair() refuses: they did not say how the surface goes on.
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
    ignored: list[int] = field(default_factory=list)


# By code: what mends a mesh so that a hole can be filled.
_CURES = {
    "COINCIDENT_VERTICES": "merge",
    "DEGENERATE_FACE": "cut",
    "INCONSISTENT_ORIENTATION": "flip",
    "NONMANIFOLD_EDGE": "delete",
}


@dataclass(frozen=True, slots=True)
class SkippedHole:
    """What could not be filled, and why.

    loops: list of (k,) int64
        The rim of the hole, and those of its islands. None where nobody can tell what is a hole: then
        the elements are the border edges there.
    code, message: str
        What is wrong and what to do about it, as in FairingError.
    why: str
        The message without the elements.
    elements: list
        Ids of vertices, or edges as pairs (a, b) of vertices.
    kind: "vertex" or "edge"
        What the elements are.
    cure: str
        What makes it a hole that can be filled: "merge" the vertices by distance; "cut" an edge at the
        vertex that lies on it; "flip" the faces that look the other way; "delete" the faces that are
        too many; empty where there is no such command.
    """

    loops: list[np.ndarray]
    code: str
    message: str
    why: str
    elements: list[int] | list[tuple[int, int]]
    kind: str
    cure: str

    @classmethod
    def of(cls, loops: list[np.ndarray], why: dict[str, Any], ids: np.ndarray) -> SkippedHole:
        """From what the core says of a part of the mesh with these `ids` (n,) of vertices."""
        found = ids[np.array(why["elements"], np.int64)].tolist()
        if why["kind"] == "edge":
            found = [tuple(edge) for edge in found]
        return cls(
            loops,
            why["code"],
            f"At {_named(why['kind'], found)}: {why['message']}",
            why["message"],
            found,
            why["kind"],
            _CURES.get(why["code"], ""),
        )


def _named(kind: str, elements: list[Any]) -> str:
    """ "vertex 3", "vertices 3, 4", "edges 3-4, 4-5, …"."""
    many = {"vertex": "vertices", "edge": "edges"}[kind]
    shown = ["-".join(map(str, e)) if kind == "edge" else str(e) for e in elements[:_SHOWN]]
    more = ["…"] if len(elements) > _SHOWN else []
    return f"{kind if len(elements) == 1 else many} {', '.join(shown + more)}"


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
        What closed each hole, in the order of the holes, but for those that are skipped.
    skipped: list of SkippedHole
        What could not be filled. It is as it was.
    """

    vertices: np.ndarray
    faces: np.ndarray | tuple[np.ndarray, np.ndarray]
    new_faces: np.ndarray
    holes: list[FilledHole]
    skipped: list[SkippedHole]


def put_together(
    mesh: MeshPart,
    loops: Sequence[list[np.ndarray]],
    fillings: Sequence[Filling],
    told: Sequence[tuple[int, str]],
    skipped: list[SkippedHole],
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
        holes.append(FilledHole(rims, more, filled, *found, list(by.ignored)))
        vertex, face = more.stop, filled.stop
    vertices = np.concatenate([mesh.points, *(f.own for f in fillings)])
    new = [f.faces.astype(np.int64).ravel() for f in fillings]
    corners = np.concatenate([mesh.corners, *new])
    more_sizes = [np.full(len(f.faces), f.faces.shape[1]) for f in fillings]
    sizes = np.concatenate([np.diff(mesh.offsets), *more_sizes])
    if (sizes == 3).all():
        whole: Any = corners.reshape(-1, 3)
    else:
        whole = corners, np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    return Filled(vertices, whole, np.arange(faces, face), holes, skipped)
