# SPDX-License-Identifier: GPL-3.0-or-later
"""A control mesh with its edges, and the lengths, areas and angles that are measured of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .arrays import edges_of, face_vectors, following, marked, pair_keys

# half: the cosine of a turn of 60°, above which a border has a corner
_COSINE_OF_CORNER = 0.5


@dataclass(frozen=True)
class ControlMesh:
    """A mesh of n vertices, e edges, m faces and c face corners. What is computed is kept."""

    positions: np.ndarray  # (n, 3) float64
    corners: np.ndarray  # (c,) int, vertices of the faces, face after face
    offsets: np.ndarray  # (m + 1,) int: face f has the corners offsets[f] … offsets[f + 1] - 1
    edges: np.ndarray  # (e, 2) int, vertex pairs
    corner_edges: np.ndarray  # (c,) int, the edge that leaves each corner

    @classmethod
    def of(cls, positions: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> ControlMesh:
        """The mesh of these faces, none of them empty."""
        return cls(positions, corners, offsets, *edges_of(corners, offsets))

    def has_pair(self, pairs: np.ndarray) -> np.ndarray:
        """(e,) bool: the edges that are among the vertex pairs (k, 2)."""
        return np.isin(pair_keys(self.edges), pair_keys(pairs))

    @cached_property
    def face_sizes(self) -> np.ndarray:
        """(m,) int: number of corners of each face."""
        return np.diff(self.offsets)

    @cached_property
    def face_of(self) -> np.ndarray:
        """(c,) int: the face of each corner."""
        return np.repeat(np.arange(len(self.face_sizes)), self.face_sizes)

    @cached_property
    def edge_uses(self) -> np.ndarray:
        """(e,) int: number of faces at each edge."""
        return np.bincount(self.corner_edges, minlength=len(self.edges))

    @cached_property
    def faces_of_edges(self) -> np.ndarray:
        """(e, 2) int: the two faces of each edge. Only meaningful if `edge_uses` is 2."""
        pair = np.zeros((len(self.edges), 2), np.int64)
        pair[self.corner_edges, 1] = self.face_of  # the last assignment wins
        pair[self.corner_edges[::-1], 0] = self.face_of[::-1]
        return pair

    @cached_property
    def edge_lengths(self) -> np.ndarray:
        """(e,)"""
        ends = self.positions[self.edges]
        return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)

    @cached_property
    def face_vectors(self) -> np.ndarray:
        """(m, 3) vectors along the normals, with twice the areas as lengths."""
        return face_vectors(self.positions, self.corners, self.offsets)

    @property
    def face_areas(self) -> np.ndarray:
        """(m,)"""
        return 0.5 * np.linalg.norm(self.face_vectors, axis=1)

    @property
    def face_normals(self) -> np.ndarray:
        """(m, 3) unit normals; zero for faces without area."""
        length = np.linalg.norm(self.face_vectors, axis=1)
        return self.face_vectors / np.where(length > 0, length, 1.0)[:, None]

    @property
    def face_centres(self) -> np.ndarray:
        """(m, 3): means of the faces' corners."""
        sums = np.add.reduceat(self.positions[self.corners], self.offsets[:-1], axis=0)
        return sums / self.face_sizes[:, None]

    @cached_property
    def fold_angles(self) -> tuple[np.ndarray, np.ndarray]:
        """(e,) degrees between each edge's two faces as if oriented alike; (e,) bool: has two."""
        normals, pair = self.face_normals, self.faces_of_edges
        if not len(normals):
            return np.zeros(len(pair)), np.zeros(len(pair), bool)
        forward = self.edges[self.corner_edges, 0] == self.corners
        same_way = np.bincount(self.corner_edges, forward, len(self.edges)) != 1
        first, second = normals[pair[:, 0]], normals[pair[:, 1]]
        second = np.where(same_way[:, None], -second, second)
        # from the lengths of sum and difference, since arccos would lose half of its digits near 0°
        apart = np.linalg.norm(first - second, axis=1)
        together = np.linalg.norm(first + second, axis=1)
        inside = (self.edge_uses == 2) & (normals != 0.0).any(axis=1)[pair].all(axis=1)
        return np.degrees(2.0 * np.arctan2(apart, together)), inside

    def border_corners(self, smooth: np.ndarray) -> np.ndarray:
        """Corners (c,) of the border. Here the angle of the sheet, over all its faces, is so small that
        the border turns by more than 60°, and neither border edge is `smooth` (e,) bool; or the vertex
        has a single face and turns as much the other way.
        """
        count, corners = len(self.positions), self.corners
        points, after = self.positions[corners], following(self.offsets)
        ahead = points[after] - points
        back = np.empty_like(ahead)
        back[after] = -ahead
        across = np.cross(ahead, back)
        outwards = np.einsum("ij,ij->i", across, self.face_vectors[self.face_of])
        sines = np.copysign(np.linalg.norm(across, axis=1), outwards)
        angles = np.arctan2(sines, np.einsum("ij,ij->i", ahead, back))
        single = np.bincount(corners, minlength=count)[corners] == 1
        angles = np.where(single, np.abs(angles), angles % (2 * np.pi))
        border = self.edge_uses == 1
        # at 120° exactly, rounding would decide
        turns = np.bincount(corners, angles, minlength=count) < np.arccos(-_COSINE_OF_CORNER) - 1e-9
        turns &= marked(self.edges[border], count) & ~marked(self.edges[border & smooth], count)
        return np.flatnonzero(turns)
