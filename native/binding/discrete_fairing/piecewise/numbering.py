# SPDX-License-Identifier: GPL-3.0-or-later
"""Ids of a surface's points by control elements, as native/grid/grid_level.h has them."""

from __future__ import annotations

from dataclasses import dataclass

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
    def first_edge_point(self) -> int:
        return self.vertices

    @property
    def first_face_point(self) -> int:
        return self.vertices + self.edges * (self.n - 1)

    @property
    def size(self) -> int:
        inside = [self.lattice(quad).interior_count for quad in (False, True)]
        return self.first_face_point + self.triangles * inside[0] + self.quads * inside[1]

    def edge_bases(self, edges: np.ndarray) -> np.ndarray:
        return self.first_edge_point + edges.astype(np.int64) * (self.n - 1)

    def face_bases(self, faces: np.ndarray, quads_before: np.ndarray) -> np.ndarray:
        """The first interior point of each face. `quads_before`: the number of quads before it."""
        inside = [self.lattice(quad).interior_count for quad in (False, True)]
        before = quads_before.astype(np.int64)
        return self.first_face_point + (faces - before) * inside[0] + before * inside[1]


def closed_ids(
    numbering: Numbering,
    corner: np.ndarray,
    edge: np.ndarray,
    reversed_side: np.ndarray,
    base: np.ndarray,
    lattice: Lattice,
) -> np.ndarray:
    """(f, closed) int64: all points of these faces, which are all triangles or all quads.

    corner, edge, reversed_side: (f, 3 or 4), for their sides; base: (f,), their first interior points.
    """
    n = numbering.n
    ids = np.empty((len(corner), len(lattice.i)), np.int64)
    ids[:, lattice.corners] = corner
    along = np.arange(n - 1)
    for s in range(lattice.size):
        k = np.where(reversed_side[:, s, None].astype(bool), n - 2 - along, along)
        ids[:, lattice.sides[s]] = numbering.edge_bases(edge[:, s])[:, None] + k
    ids[:, lattice.interior] = base[:, None] + np.arange(lattice.interior_count)
    return ids
