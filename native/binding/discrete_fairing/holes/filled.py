# SPDX-License-Identifier: GPL-3.0-or-later
"""Fillings of the holes of a mesh, their reports, and the filled mesh."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from .._native import FairingError
from ..errors import about, fairing_error
from ..mesh_part import MeshPart
from .edge_cuts import Cuts, cut_faces


@dataclass(frozen=True, slots=True)
class FilledHole:
    """The filling of one hole.

    loops: list of (k,) int64
        Its rim, and those of its islands.
    vertices: (k, 3) float64
        The new vertices.
    faces: (t, 3) int64
        The new faces. Ids below the number of vertices of the mesh are the mesh's; the new vertices
        follow, hole after hole.
    energy: str
        The energy that was minimized; "none" for the first triangulation, spread as a membrane.
    joint: str
        What it continues at the rim.
    converged: bool
        Whether its steps converged; False for a triangulation.
    folds: int
        Edges at which the surface turns by more than a right angle, the rim's included.
    crossings: int
        Faces of the filling that cross others, of the mesh or of a filling.
    ignored: list of int
        Faces around it that fair() refuses; they were not used to continue the surface.
    """

    loops: list[np.ndarray]
    vertices: np.ndarray
    faces: np.ndarray
    energy: str
    joint: str
    converged: bool
    folds: int
    crossings: int = 0
    ignored: list[int] = field(default_factory=list)


# The command, by error code, that mends a mesh so that a hole can be filled.
_CURES = {
    "COINCIDENT_VERTICES": "merge",
    "DEGENERATE_FACE": "cut",
    "INCONSISTENT_ORIENTATION": "flip",
    "NONMANIFOLD_EDGE": "delete",
}


@dataclass(frozen=True, slots=True)
class SkippedHole:
    """A hole that could not be filled.

    loops: list of (k,) int64
        The rim of the hole, and those of its islands. Empty if the hole is ambiguous: then the elements
        are the border edges there.
    error: FairingError
        What is wrong and what to do about it. It is not raised.
    """

    loops: list[np.ndarray]
    error: FairingError

    @classmethod
    def of(cls, loops: list[np.ndarray], why: dict[str, Any], ids: np.ndarray) -> SkippedHole:
        """From the core's error about a part of the mesh whose vertices have these `ids` (n,)."""
        found = ids[np.array(why["elements"], np.int64)].tolist()
        return cls(loops, fairing_error(**{**why, "elements": found}))

    @property
    def code(self) -> str:
        return self.error.code

    @property
    def message(self) -> str:
        return str(self.error)

    @property
    def kind(self) -> str:
        """The kind of the elements: "vertex", "edge", or "mesh" if there are none."""
        return self.error.kind

    @property
    def elements(self) -> list[Any]:
        """Ids of vertices, or edges as pairs (a, b) of vertices."""
        ids = list(self.error.elements)
        return list(zip(ids[::2], ids[1::2], strict=True)) if self.kind == "edge" else ids

    @property
    def cure(self) -> str:
        """The command after which the hole can be filled: "merge" vertices by distance; "cut" an edge at
        the vertex on it; "flip" faces of opposite orientation; "delete" surplus faces; empty if there is
        no such command.
        """
        return _CURES.get(self.code, "")


@dataclass(frozen=True)
class Filled:
    """The fillings of a mesh's holes.

    holes: list of FilledHole
        The filling of each hole, in the order of the holes, without skipped ones.
    skipped: list of SkippedHole
        The holes that could not be filled; they are unchanged.
    cuts: dict
        Of holes without area: the sides of faces that were cut at the vertices on them in place of a
        filling, as (begin, end): list of vertices between.
    """

    holes: list[FilledHole]
    skipped: list[SkippedHole]
    cuts: Cuts
    _mesh: MeshPart = field(repr=False)

    @cached_property
    def vertices(self) -> np.ndarray:
        """(N, 3) float64 vertices of the filled mesh; the n old ones come first, to the last bit."""
        return np.concatenate([self._mesh.points, *(hole.vertices for hole in self.holes)])

    @cached_property
    def faces(self) -> Any:
        """(M, 3) int64 faces of the filled mesh, or the pair (corners, offsets) if not all are triangles.
        The m old ones come first; the first piece of a cut triangle keeps its place, the others come last.
        """
        corners, offsets = self.uncut
        if self.cuts:
            corners, offsets = cut_faces(corners, offsets, self.cuts)
        return corners.reshape(-1, 3) if (np.diff(offsets) == 3).all() else (corners, offsets)

    @cached_property
    def uncut(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners and offsets of all faces before `cuts`."""
        mesh, new = self._mesh, [hole.faces for hole in self.holes]
        corners = np.concatenate([mesh.corners, *(faces.ravel() for faces in new)])
        sizes = np.concatenate([np.diff(mesh.offsets), np.full(sum(map(len, new)), 3)])
        return corners, np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)

    @property
    def reasons(self) -> list[str]:
        """Why holes are skipped: each reason once, with the elements of all its holes; most frequent first."""
        alike: dict[tuple[str, ...], list[FairingError]] = {}
        for hole in self.skipped:
            key = hole.code, hole.kind, *hole.error._sentences
            alike.setdefault(key, []).append(hole.error)
        ranked = sorted(alike.values(), key=len, reverse=True)
        return [str(about(same[0], [v for e in same for v in e.elements])) for same in ranked]

    @property
    def new_faces(self) -> np.ndarray:
        """(M - m,) int64 ids of the new faces, which are triangles."""
        count = len(self.faces if isinstance(self.faces, np.ndarray) else self.faces[1][1:])
        return np.arange(len(self._mesh.offsets) - 1, count)
