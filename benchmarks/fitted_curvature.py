# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature at single vertices, by polynomials fitted to two rings [Cazals, Pouget 2003]; without
the core.

Cotangent weights and angle defects are right in sums (surface_measures.py), but not at single
vertices of uncommon valence, which is what control vertices are: on an exact sphere, the refined
hull of 20 points, they say up to 2.8 times what they say around, and fits up to 1.01 times.
"""

from collections.abc import Sequence

import numpy as np

CUBIC_FROM = 14  # neighbours; with fewer the fit is quadratic


class FittedCurvature:
    """√(κ₁² + κ₂²) at vertices of a triangle mesh."""

    def __init__(self, points: np.ndarray, triangles: np.ndarray):
        from scipy.sparse import coo_array

        self.points, count = points, len(points)
        corner = points[triangles]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        self.normals = np.zeros_like(points)
        for k in range(3):
            np.add.at(self.normals, triangles[:, k], normal)
        ends = triangles[:, [0, 1, 1, 2, 2, 0, 1, 0, 2, 1, 0, 2]].reshape(-1, 2).T
        self.rings = coo_array((np.ones(ends.shape[1]), tuple(ends)), shape=(count, count)).tocsr()

    def ring(self, vertex: int) -> np.ndarray:
        """The neighbours of a vertex."""
        return self.rings.indices[self.rings.indptr[vertex] : self.rings.indptr[vertex + 1]]

    def at(self, vertices: Sequence[int]) -> np.ndarray:
        """The curvature at these vertices."""
        return np.array([self._one(vertex) for vertex in vertices])

    def _one(self, vertex: int) -> float:
        ring = self.ring(vertex)
        near = np.unique(np.concatenate([ring, *(self.ring(v) for v in ring)]))
        offset = self.points[near[near != vertex]] - self.points[vertex]
        frame = np.linalg.qr(np.column_stack([self.normals[vertex], np.eye(3)]))[
            0
        ]  # its first column is ± the normal
        z, x, y = (offset @ frame).T
        size = np.sqrt((x * x + y * y).mean())
        x, y, z = x / size, y / size, z / size
        columns = [x, y, x * x / 2, x * y, y * y / 2]
        if len(x) >= CUBIC_FROM:
            columns += [x**3, x * x * y, x * y * y, y**3]
        p, q, xx, xy, yy, *_ = np.linalg.lstsq(np.stack(columns, -1), z, rcond=None)[0]
        metric = np.array([[1 + p * p, p * q], [p * q, 1 + q * q]])
        form = np.array([[xx, xy], [xy, yy]]) / (size * np.sqrt(1 + p * p + q * q))
        operator = np.linalg.solve(metric, form)
        return float(np.sqrt(max(0.0, np.trace(operator @ operator))))
