# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the core's control faces in its result: the vertices and the input's corners of each.

An input polygon may be split into several control faces; all triangles of a fan have its centre last.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core import ControlArrays


@dataclass(frozen=True)
class ControlFaces:
    """F control faces with k corners each."""

    vertices: np.ndarray  # (F, k) int32; ids from the vertex count on are centres of fans
    # (F, k) int32, corners of the input; ids from the corner count on are centres of fans
    corners: np.ndarray
    polygon: np.ndarray  # (F,) int32, the input face

    @property
    def size(self) -> int:
        """k"""
        return self.vertices.shape[1]


def find_control_faces(
    fine: np.ndarray, fine_polygon: np.ndarray, lattice: Any, arrays: ControlArrays
) -> ControlFaces:
    """ControlFaces of the refined faces `fine` (f, k); `fine_polygon` (f,): their input faces; the core's `lattice`."""
    own = lattice.first_corner[lattice.corners]
    vertices = fine.reshape(-1, lattice.cells.size)[:, own]
    polygon = fine_polygon[:: len(lattice.cells)]
    return ControlFaces(vertices, _corners(vertices, polygon, arrays), polygon)


def _corners(vertices: np.ndarray, polygon: np.ndarray, arrays: ControlArrays) -> np.ndarray:
    """(F, k) int32: the corner of `polygon` at each of the `vertices`."""
    size = vertices.shape[1]
    first = arrays.offsets[polygon]
    found = first[:, None] + np.arange(size, dtype=np.int32)
    whole = arrays.offsets[polygon + 1] - first == size
    whole[whole] = (arrays.corners[found[whole]] == vertices[whole]).all(axis=1)
    split = np.flatnonzero(~whole)  # or reversed
    if len(split):
        found[split] = _search(vertices[split], polygon[split], arrays)
    return found


def _search(vertices: np.ndarray, polygon: np.ndarray, arrays: ControlArrays) -> np.ndarray:
    # no polygon contains a vertex twice, so polygon and vertex determine a corner
    centre = vertices - len(arrays.positions)
    wanted = _keys(polygon[:, None], vertices)
    polygons = np.unique(polygon)
    sizes = arrays.offsets[polygons + 1] - arrays.offsets[polygons]
    within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    candidates = np.repeat(arrays.offsets[polygons], sizes) + within
    keys = _keys(np.repeat(polygons, sizes), arrays.corners[candidates])
    order = np.argsort(keys)
    place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    return np.where(centre >= 0, len(arrays.corners) + centre, candidates[order[place]]).astype(
        np.int32
    )


def _keys(polygon: np.ndarray, vertex: np.ndarray) -> np.ndarray:
    return polygon.astype(np.int64) << 32 | vertex


class Centres:
    """The centres of all fans, each of control triangles one after another."""

    def __init__(self, triangles: ControlFaces, arrays: ControlArrays) -> None:
        """`triangles`: ControlFaces of size 3; `arrays`: the input mesh."""
        n, c = len(arrays.positions), len(arrays.corners)
        fan = triangles.vertices[:, 2] >= n
        self._vertices = triangles.vertices[fan, 0]
        self._corners = triangles.corners[fan, 0]
        centre = triangles.corners[fan, 2] - c
        self._starts = np.flatnonzero(np.diff(centre, prepend=-1))
        self.count = len(self._starts)
        self._sizes = np.diff(self._starts, append=len(centre))
        self._weights = self._area_weights(arrays.positions)

    def corner(self, values: np.ndarray) -> np.ndarray:
        """(c, w) values of input corners → (centres, w) float64."""
        return self._mean(values[self._corners])

    def point(self, values: np.ndarray) -> np.ndarray:
        """(n, w) values of control vertices → (centres, w) float64."""
        return self._mean(values[self._vertices])

    def _mean(self, values: np.ndarray) -> np.ndarray:
        if not self.count:
            return np.empty((0, values.shape[1]))
        return np.add.reduceat(values * self._weights[:, None], self._starts, axis=0)

    def _area_weights(self, positions: np.ndarray) -> np.ndarray:
        """(members,) float64: with these weights the mean of the corners is the area centroid, where
        the core places the centre.

        So a value that is linear in the plane of a polygon stays linear. A centroid outside the
        corners' hull, which strongly warped polygons may have, is replaced by the plain mean.
        """
        plain = 1.0 / np.repeat(self._sizes, self._sizes)
        if not self.count:
            return plain
        points = positions[self._vertices]
        mean = np.add.reduceat(points * plain[:, None], self._starts, axis=0)
        arm = points - np.repeat(mean, self._sizes, axis=0)
        after = self._starts + self._sizes - 1
        step = np.arange(1, len(arm) + 1)
        step[after] = self._starts
        normal = np.cross(arm, arm[step])
        whole = np.repeat(np.add.reduceat(normal, self._starts, axis=0), self._sizes, axis=0)
        part = np.einsum("ij,ij->i", normal, whole) / np.maximum(
            np.einsum("ij,ij->i", whole, whole), 1e-300
        )
        before = np.empty_like(part)
        before[step] = part
        weights = (plain + part + before) / 3
        usable = np.logical_and.reduceat(weights >= 0, self._starts)
        return np.where(np.repeat(usable, self._sizes), weights, plain)
