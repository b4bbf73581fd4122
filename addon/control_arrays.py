# SPDX-License-Identifier: GPL-3.0-or-later
"""A control mesh as plain arrays, and its creases, corners and marked borders. No Blender."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .choices import EDGE_BOUNDARIES


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

    @property
    def has_flats(self) -> bool:
        """Whether faces are to be kept flat."""
        return self.flat_face is not None and bool(self.flat_face.any())

    @cached_property
    def face_sizes(self) -> np.ndarray:
        """(m,) int32: number of corners of each face."""
        return self.offsets[1:] - self.offsets[:-1]

    @cached_property
    def face_of(self) -> np.ndarray:
        """(c,) int32: the face of each corner."""
        return np.repeat(np.arange(len(self.face_sizes), dtype=np.int32), self.face_sizes)

    @cached_property
    def edge_uses(self) -> np.ndarray:
        """(e,) int: number of faces at each edge."""
        return np.bincount(self.corner_edges, minlength=len(self.edges))

    @property
    def border_edges(self) -> np.ndarray:
        """(b, 2) int32: vertex pairs of the edges with one face."""
        return self.edges[self.edge_uses == 1]

    @property
    def mean_edge_length(self) -> float:
        """Mean length of the edges with faces; 0 if there are none."""
        ends = self.positions[self.edges[self.edge_uses > 0]]
        lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return float(lengths.mean()) if len(lengths) else 0.0

    def has_faces_of(self, other: "ControlArrays | None") -> bool:
        """Whether the two meshes differ in vertex positions only."""
        return (
            other is not None
            and np.array_equal(self.corners, other.corners)
            and np.array_equal(self.offsets, other.offsets)
        )

    def crease_edges(self, threshold: float | None, use_sharp: bool) -> np.ndarray:
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

    def corner_vertices(self, threshold: float | None) -> np.ndarray:
        """Vertices (c,) int32 with faces and a crease of at least `threshold`, None for none."""
        if threshold is None or self.vertex_crease is None:
            return np.empty(0, np.int32)
        chosen = _creased(self.vertex_crease, threshold) & self.has_face
        return np.flatnonzero(chosen).astype(np.int32)

    @property
    def has_face(self) -> np.ndarray:
        """(n,) bool: which vertices belong to faces."""
        return np.bincount(self.corners, minlength=len(self.positions)) > 0


def _sharpness(creases: np.ndarray) -> np.ndarray:
    """Blender's creases, from 0 to 1, as the number of subdivision steps during which they are sharp."""
    return 10.0 * creases.astype(np.float64) ** 2


def _creased(weights: np.ndarray, threshold: float) -> np.ndarray:
    return (weights > 0.0) & (weights >= np.float32(threshold))
