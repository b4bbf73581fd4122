# SPDX-License-Identifier: GPL-3.0-or-later
"""A control mesh as plain arrays, and its creases, corners and marked borders. No Blender."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .choices import EDGE_BOUNDARIES

# half: the cosine of a turn of 60°, above which a border has a corner
_COSINE_OF_CORNER = 0.5


@dataclass(frozen=True)
class ControlArrays:
    """A control mesh of n vertices, e edges, m faces and c face corners. What is computed is kept."""

    positions: np.ndarray  # (n, 3) float64
    edges: np.ndarray  # (e, 2) int32, vertex pairs
    corners: np.ndarray  # (c,) int32, vertices of the faces, face after face
    corner_edges: np.ndarray  # (c,) int32, the edge that leaves each corner
    offsets: np.ndarray  # (m + 1,) int32: face f has the corners offsets[f] … offsets[f + 1] - 1
    edge_crease: np.ndarray | None  # (e,) float32
    vertex_crease: np.ndarray | None  # (n,) float32
    sharp_edge: np.ndarray | None  # (e,) bool
    # (e,) int32, the boundary of each border edge, numbered as in choices.EDGE_BOUNDARIES
    boundary_edge: np.ndarray | None = None
    normals: np.ndarray | None = None  # (n, 3) fixed normals of the surface; zero: none
    flat_face: np.ndarray | None = None  # (m,) bool: faces to keep flat

    @cached_property
    def face_sizes(self) -> np.ndarray:
        """(m,) int32: number of corners of each face."""
        return self.offsets[1:] - self.offsets[:-1]

    @cached_property
    def face_of(self) -> np.ndarray:
        """(c,) int32: the face of each corner."""
        return np.repeat(np.arange(len(self.face_sizes), dtype=np.int32), self.face_sizes)

    @cached_property
    def following(self) -> np.ndarray:
        """(c,) int: the next corner around the face."""
        after, some = np.arange(1, len(self.corners) + 1), self.face_sizes > 0
        after[self.offsets[1:][some] - 1] = self.offsets[:-1][some]
        return after

    @cached_property
    def edge_uses(self) -> np.ndarray:
        """(e,) int: number of faces at each edge."""
        return np.bincount(self.corner_edges, minlength=len(self.edges))

    @property
    def border_edges(self) -> np.ndarray:
        """(b, 2) int32: vertex pairs of the edges with one face."""
        return self.edges[self.edge_uses == 1]

    @cached_property
    def faces_of_edges(self) -> np.ndarray:
        """(e, 2) int32: the two faces of each edge. Only meaningful if `edge_uses` is 2."""
        pair = np.zeros((len(self.edges), 2), np.int32)
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
        """(m, 3) vectors along the normals, with twice the areas as lengths, by Newell's sum."""
        sums, some = np.zeros((len(self.face_sizes), 3)), self.face_sizes > 0
        starts = self.offsets[:-1][some]
        if len(starts):
            # relative to the first corner of each face, since the sum would lose digits far from the origin
            points = self.positions[self.corners]
            local = points - np.repeat(points[starts], self.face_sizes[some], axis=0)
            sums[some] = np.add.reduceat(np.cross(local, local[self.following]), starts)
        return sums

    @property
    def face_areas(self) -> np.ndarray:
        """(m,)"""
        return 0.5 * np.linalg.norm(self.face_vectors, axis=1)

    @property
    def face_normals(self) -> np.ndarray:
        """(m, 3) unit normals; zero for faces without area."""
        length = np.linalg.norm(self.face_vectors, axis=1)
        return self.face_vectors / np.where(length > 0, length, 1.0)[:, None]

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

    @property
    def face_centres(self) -> np.ndarray:
        """(m, 3): means of the faces' corners."""
        sums = np.add.reduceat(self.positions[self.corners], self.offsets[:-1], axis=0)
        return sums / self.face_sizes[:, None]

    @property
    def mean_edge_length(self) -> float:
        """Mean length of the edges with faces; 0 if there are none."""
        lengths = self.edge_lengths[self.edge_uses > 0]
        return float(lengths.mean()) if len(lengths) else 0.0

    def has_faces_of(self, other: "ControlArrays | None") -> bool:
        """Whether the two meshes differ in vertex positions only."""
        return (
            other is not None
            and np.array_equal(self.corners, other.corners)
            and np.array_equal(self.offsets, other.offsets)
        )

    def crease_edges(self, threshold: float | None = None, use_sharp: bool = False) -> np.ndarray:
        """Vertex pairs (k, 2) int32 of edges with a crease of at least `threshold` or, with
        `use_sharp`, marked sharp.

        `threshold` None ignores creases. A weight of 0 is never a crease. Edges without a face are left
        out, since they carry no surface.
        """
        chosen = np.zeros(len(self.edges), bool)
        if threshold is not None and self.edge_crease is not None:
            chosen |= _creased(self.edge_crease, threshold)
        if use_sharp and self.sharp_edge is not None:
            chosen |= self.sharp_edge
        return self.edges[chosen & (self.edge_uses > 0)]

    def soft_creases(self, threshold: float) -> tuple[np.ndarray, np.ndarray]:
        """Vertex pairs (k, 2) int32 and weights (k,) of edges with a crease below `threshold`. Not for
        limit positions, which follow these creases already, like Subdivision Surface.
        """
        if self.edge_crease is None:
            return np.empty((0, 2), np.int32), np.empty(0)
        weights = self.edge_crease
        chosen = (weights > 0.0) & ~_creased(weights, threshold) & (self.edge_uses > 0)
        return self.edges[chosen], weights[chosen].astype(np.float64)

    def edge_sharpness(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Vertex pairs (k, 2) int32 and sharpness (k,) of all creased edges; None without creases."""
        if self.edge_crease is None:
            return None
        creased = (self.edge_crease > 0) & (self.edge_uses > 0)
        return self.edges[creased], _sharpness(self.edge_crease[creased])

    def vertex_sharpness(self) -> np.ndarray:
        """(n,) as in Blender: corners of sheets are as sharp as their softer edge, or their own."""
        count = len(self.positions)
        own = np.zeros(count) if self.vertex_crease is None else _sharpness(self.vertex_crease)
        if self.edge_crease is None:
            return own
        ends, sharpness = self.edges.ravel(), np.repeat(_sharpness(self.edge_crease), 2)
        softer = np.full(count, np.inf)
        np.minimum.at(softer, ends, sharpness)
        two = np.bincount(ends, minlength=count) == 2
        return np.where(two, np.minimum(own + np.where(two, softer, 0.0), 10.0), own)

    def boundary_edges(self) -> dict[str, np.ndarray]:
        """Vertex pairs (k, 2) int32 of marked edges with faces, by the name of the boundary."""
        if self.boundary_edge is None:
            return {}
        used = self.edge_uses > 0
        marked = {
            key.lower(): self.edges[used & (self.boundary_edge == number)]
            for key, *_, number in EDGE_BOUNDARIES
            if number
        }
        return {name: edges for name, edges in marked.items() if len(edges)}

    def corner_vertices(self, threshold: float | None = None) -> np.ndarray:
        """Vertices (c,) int32 with faces and a crease of at least `threshold`, None for none."""
        if threshold is None or self.vertex_crease is None:
            return np.empty(0, np.int32)
        chosen = _creased(self.vertex_crease, threshold) & self.has_face
        return np.flatnonzero(chosen).astype(np.int32)

    @property
    def has_face(self) -> np.ndarray:
        """(n,) bool: which vertices belong to faces."""
        return np.bincount(self.corners, minlength=len(self.positions)) > 0

    def border_corners(self) -> np.ndarray:
        """Corners (c,) int32 of the border. Here the angle of the sheet, over all its faces, is so
        small that the border turns by more than 60°, and neither border edge has a boundary of its own;
        or the vertex has a single face and turns as much the other way.
        """
        count, corners = len(self.positions), self.corners
        points = self.positions[corners]
        ahead = points[self.following] - points
        back = np.empty_like(ahead)
        back[self.following] = -ahead
        across = np.cross(ahead, back)
        outwards = np.einsum("ij,ij->i", across, self.face_vectors[self.face_of])
        sines = np.copysign(np.linalg.norm(across, axis=1), outwards)
        angles = np.arctan2(sines, np.einsum("ij,ij->i", ahead, back))
        single = np.bincount(corners, minlength=count)[corners] == 1
        angles = np.where(single, np.abs(angles), angles % (2 * np.pi))
        angle = np.bincount(corners, angles, minlength=count)
        # at 120° exactly, rounding would decide
        turns = (angle < np.arccos(-_COSINE_OF_CORNER) - 1e-9) & np.isin(
            np.arange(count), self.border_edges
        )
        if self.boundary_edge is not None:
            marked = (self.boundary_edge != 0) & (self.edge_uses == 1)
            turns &= ~np.isin(np.arange(count), self.edges[marked])
        return np.flatnonzero(turns).astype(np.int32)


def _sharpness(creases: np.ndarray) -> np.ndarray:
    """Blender's creases, from 0 to 1, as the number of subdivision steps during which they are sharp."""
    return 10.0 * creases.astype(np.float64) ** 2


def _creased(weights: np.ndarray, threshold: float) -> np.ndarray:
    return (weights > 0.0) & (weights >= np.float32(threshold))
