# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature at the vertices of a triangle mesh: plain arrays, no Blender.

Cotangent Laplacian and angle defect over mixed Voronoi areas (Meyer, Desbrun, Schröder, Barr 2003).
"""

from dataclasses import dataclass

import numpy as np

from .polygons import cross, marked_vertices, rim_edges, triangulate, unit


@dataclass(frozen=True)
class Curvature:
    """At n vertices; lengths in mesh units."""

    mean: np.ndarray  # (n,) float64, (κ₁ + κ₂) / 2, positive where the side of the normals bulges
    gauss: np.ndarray  # (n,) float64, κ₁ κ₂
    area: np.ndarray  # (n,) float64, of the surface that belongs to each vertex
    inner: (
        np.ndarray
    )  # (n,) bool: measured there. Elsewhere the mean of the measured neighbours, or 0 without any

    @property
    def total(self):
        """(n,) float64, κ₁² + κ₂²."""
        # never below 2 H² or 2 |K| on a smooth surface; the discrete H and K may disagree by rounding
        return np.maximum(4.0 * self.mean**2 - 2.0 * self.gauss, 0.0)

    @property
    def largest(self):
        """(n,) float64, the larger of |κ₁| and |κ₂|."""
        return np.abs(self.mean) + np.sqrt(np.maximum(self.mean**2 - self.gauss, 0.0))


def curvature(arrays):
    """Curvature of a polygon mesh (see polygons). Not measured at borders and along edges marked sharp."""
    triangles, weights = triangulate(arrays.positions, arrays.corners, arrays.offsets)
    rim = marked_vertices(arrays.edges, rim_edges(arrays), len(arrays.positions))
    return triangle_curvature(arrays.positions, triangles, weights, rim, arrays.edges)


def triangle_curvature(positions, triangles, weights, rim, edges):
    """`positions` (n, 3) float64, `triangles` (t, 3) int, each counting `weights` (t,) times.

    `rim` (n,) bool: vertices where curvature makes no sense.

    Those take the mean of their neighbours along `edges` (e, 2).
    """
    count = len(positions)
    corners = [triangles[:, i] for i in range(3)]
    points = [positions[ids] for ids in corners]
    side = [points[(i + 2) % 3] - points[(i + 1) % 3] for i in range(3)]  # opposite corner i
    square = [np.einsum("ij,ij->i", s, s) for s in side]
    normal = cross(side[0], side[1])
    twice_area = np.sqrt(np.einsum("ij,ij->i", normal, normal))
    sound = twice_area > 1e-14 * (square[0] + square[1] + square[2])  # slivers have no cotangent worth adding
    safe = np.where(sound, twice_area, 1.0)

    cosine = [-np.einsum("ij,ij->i", side[(i + 1) % 3], side[(i + 2) % 3]) for i in range(3)]
    cotangent = [np.where(sound, c / safe, 0.0) for c in cosine]
    angle = [np.arctan2(twice_area, c) for c in cosine]

    def gather(ids, values):
        return np.bincount(ids, weights=weights * values, minlength=count)

    area = np.zeros(count)
    defect = np.full(count, 2.0 * np.pi)
    normals, laplacian = np.zeros((count, 3)), np.zeros((count, 3))
    for i, ids in enumerate(corners):
        j, k = (i + 1) % 3, (i + 2) % 3
        area += gather(ids, _share(i, square, cotangent, cosine, twice_area))
        defect -= gather(ids, angle[i])
        # side[k] runs from corner i to corner j, side[j] from corner k to corner i
        pull = cotangent[j][:, None] * side[j] - cotangent[k][:, None] * side[k]
        for axis in range(3):
            laplacian[:, axis] += gather(ids, pull[:, axis])
            normals[:, axis] += gather(ids, normal[:, axis])

    inner = (area > 0.0) & ~rim
    safe_area = np.where(area > 0.0, area, 1.0)
    # the length of the Laplacian would be the same on a smooth surface; along the normal it keeps the sign
    mean = np.einsum("ij,ij->i", laplacian, unit(normals)) / (4.0 * safe_area)
    gauss = defect / safe_area
    return Curvature(_filled(mean, inner, edges), _filled(gauss, inner, edges), area, inner)


def _share(i, square, cotangent, cosine, twice_area):
    """(t,) the part of each triangle that belongs to corner i: its Voronoi region, cut off where the triangle is obtuse."""
    j, k = (i + 1) % 3, (i + 2) % 3
    voronoi = (square[j] * cotangent[j] + square[k] * cotangent[k]) / 8.0
    obtuse_here = cosine[i] < 0.0
    obtuse = obtuse_here | (cosine[j] < 0.0) | (cosine[k] < 0.0)
    return np.where(obtuse, np.where(obtuse_here, twice_area / 4.0, twice_area / 8.0), voronoi)


def _filled(values, inner, edges):
    """`values` where `inner`; elsewhere the mean of the inner neighbours, or 0 without any."""
    a, b = edges[:, 0], edges[:, 1]
    outward = np.concatenate([edges[inner[b] & ~inner[a]], edges[inner[a] & ~inner[b]][:, ::-1]])
    total = np.bincount(outward[:, 0], weights=values[outward[:, 1]], minlength=len(values))
    number = np.bincount(outward[:, 0], minlength=len(values))
    return np.where(inner, values, total / np.maximum(number, 1))
