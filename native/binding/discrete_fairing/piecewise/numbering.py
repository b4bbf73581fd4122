# SPDX-License-Identifier: GPL-3.0-or-later
"""Ids of a surface's points by control elements, as native/grid/grid_level.h has them."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..lattice import Lattice


@dataclass(frozen=True)
class Numbering:
    """The numbers of control elements, which determine the ids of a surface's points."""

    levels: int
    vertices: int
    edges: int
    triangles: int
    quads: int

    @property
    def n(self) -> int:
        return 1 << self.levels

    def lattice(self, quad: bool) -> Lattice:
        return Lattice(self.n, quad)

    @property
    def size(self) -> int:
        return int(self.face_bases(np.array(self.triangles + self.quads), np.array(self.quads)))

    def face_bases(self, faces: np.ndarray, quads_before: np.ndarray) -> np.ndarray:
        """The first interior point of each face. `quads_before`: the number of quads before it."""
        inside = [self.lattice(quad).interior_count for quad in (False, True)]
        before = quads_before.astype(np.int64)
        first = self.vertices + self.edges * (self.n - 1)
        return first + (faces - before) * inside[0] + before * inside[1]


@dataclass(frozen=True, eq=False)
class ControlFaces:
    """F control faces of a surface, with -1 in the fourth column of triangles."""

    vertex: np.ndarray  # (F, 4)
    edge: np.ndarray  # (F, 4), at its sides
    reversed: np.ndarray  # (F, 4): whether a side runs against its edge
    number: np.ndarray  # (F,)
    quads_before: np.ndarray  # (F,)
    polygon: np.ndarray  # (F,) the face of the mended mesh

    @property
    def quad(self) -> np.ndarray:
        return self.vertex[:, 3] >= 0

    def take(self, rows: np.ndarray) -> ControlFaces:
        return ControlFaces(*(getattr(self, field.name)[rows] for field in fields(self)))

    def points(self, numbering: Numbering, quad: bool) -> np.ndarray:
        """(f, closed) int64: the ids of all points of the triangles, or of the quads, by lattice point."""
        its, lattice = self.take(np.flatnonzero(self.quad == quad)), numbering.lattice(quad)
        ids = np.empty((len(its.number), len(lattice.i)), np.int64)
        ids[:, lattice.corners] = its.vertex[:, : lattice.size]
        along = np.arange(numbering.n - 1)
        for s in range(lattice.size):
            first = numbering.vertices + its.edge[:, s, None].astype(np.int64) * len(along)
            ids[:, lattice.sides[s]] = first + np.where(
                its.reversed[:, s, None].astype(bool), along[::-1], along
            )
        base = numbering.face_bases(its.number, its.quads_before)
        ids[:, lattice.interior] = base[:, None] + np.arange(lattice.interior_count)
        return ids
