# SPDX-License-Identifier: GPL-3.0-or-later
"""The core's control faces, found again in its result: which vertices, and which corners of the input, each one has.

A polygon of the input may have been split in several control faces; all triangles of a fan have its centre last.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ControlFaces:
    """F control faces with k corners each."""

    vertices: np.ndarray  # (F, k) int32; ids from the vertex count on are centres of fans
    corners: (
        np.ndarray
    )  # (F, k) int32, corners of the input; ids from the corner count on are centres of fans
    polygon: np.ndarray  # (F,) int32, the input face

    @property
    def size(self):
        """k"""
        return self.vertices.shape[1]


def find_control_faces(fine, fine_polygon, cells, arrays):
    """ControlFaces of the refined faces `fine` (f, k), written as `cells` (Cells) say; `fine_polygon` (f,): their input faces.

    `arrays`: the input mesh (positions, corners, offsets).
    """
    own = cells.first_corner[np.argmax(cells.weights, axis=0)]
    vertices = fine.reshape(-1, len(cells.corner_point))[:, own]
    polygon = fine_polygon[:: len(cells.corner_point) // fine.shape[1]]
    return ControlFaces(vertices, _corners(vertices, polygon, arrays), polygon)


def _corners(vertices, polygon, arrays):
    """(F, k) int32: the corner of `polygon` at each of the `vertices`."""
    size = vertices.shape[1]
    first = arrays.offsets[polygon]
    found = first[:, None] + np.arange(size, dtype=np.int32)
    whole = arrays.offsets[polygon + 1] - first == size
    whole[whole] = (arrays.corners[found[whole]] == vertices[whole]).all(axis=1)
    split = np.flatnonzero(~whole)  # or turned over
    if len(split):
        found[split] = _search(vertices[split], polygon[split], arrays)
    return found


def _search(vertices, polygon, arrays):
    # no polygon has a vertex twice, so polygon and vertex name a corner
    centre = vertices - len(arrays.positions)
    wanted = _keys(polygon[:, None], vertices)
    polygons = np.unique(polygon)
    sizes = arrays.offsets[polygons + 1] - arrays.offsets[polygons]
    within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    candidates = np.repeat(arrays.offsets[polygons], sizes) + within
    keys = _keys(np.repeat(polygons, sizes), arrays.corners[candidates])
    order = np.argsort(keys)
    place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    return np.where(centre >= 0, len(arrays.corners) + centre, candidates[order[place]]).astype(np.int32)


def _keys(polygon, vertex):
    return polygon.astype(np.int64) << 32 | vertex
