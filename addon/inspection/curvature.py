# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature at the vertices of a polygon mesh: plain arrays, no Blender, no loop over faces.

Cotangent Laplacian and angle defect over mixed Voronoi areas (Meyer, Desbrun, Schröder, Barr 2003).
Uses only positions, edges, corners, corner_edges, offsets and sharp_edge of ControlArrays.
"""

from dataclasses import dataclass

import numpy as np

from ..core import ControlArrays
from ..triangles import fans, marked, unit


@dataclass(frozen=True)
class Curvature:
    """Curvature at n vertices; lengths in mesh units."""

    # (n,) float64, (κ₁ + κ₂) / 2, positive if the surface bulges to the side of the normals
    mean: np.ndarray
    gauss: np.ndarray  # (n,) float64, κ₁ κ₂
    area: np.ndarray  # (n,) float64, area of the surface at each vertex
    # (n,) bool: measured there. Elsewhere the mean of the measured neighbours, or 0 without any
    inner: np.ndarray

    @property
    def total(self) -> np.ndarray:
        """(n,) float64, κ₁² + κ₂²."""
        # at least 2 H² and 2 |K| on a smooth surface; the discrete H and K may violate this by rounding
        return np.maximum(4.0 * self.mean**2 - 2.0 * self.gauss, 0.0)


def curvature(arrays: ControlArrays) -> Curvature:
    """Curvature of a polygon mesh; not at borders and edges marked sharp."""
    triangles, weights = triangulate(arrays.positions, arrays.corners, arrays.offsets)
    rim = marked(arrays.edges[rim_edges(arrays)], len(arrays.positions))
    return triangle_curvature(arrays.positions, triangles, weights, rim, arrays.edges)


def triangle_curvature(
    positions: np.ndarray,
    triangles: np.ndarray,
    weights: np.ndarray,
    rim: np.ndarray,
    edges: np.ndarray,
) -> Curvature:
    """Curvature of triangles: `positions` (n, 3) float64, `triangles` (t, 3) int with `weights` (t,).

    `rim` (n,) bool: vertices at which curvature is undefined.

    These get the mean of their neighbours along `edges` (e, 2).
    """
    count = len(positions)
    corners = [triangles[:, i] for i in range(3)]
    points = [positions[ids] for ids in corners]
    side = [points[(i + 2) % 3] - points[(i + 1) % 3] for i in range(3)]  # opposite corner i
    square = [np.einsum("ij,ij->i", s, s) for s in side]
    normal = np.cross(side[0], side[1])
    twice_area = np.sqrt(np.einsum("ij,ij->i", normal, normal))
    # slivers have no useful cotangent
    sound = twice_area > 1e-14 * (square[0] + square[1] + square[2])
    safe = np.where(sound, twice_area, 1.0)

    cosine = [-np.einsum("ij,ij->i", side[(i + 1) % 3], side[(i + 2) % 3]) for i in range(3)]
    cotangent = [np.where(sound, c / safe, 0.0) for c in cosine]
    angle = [np.arctan2(twice_area, c) for c in cosine]

    def gather(ids: np.ndarray, values: np.ndarray) -> np.ndarray:
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
    # the length of the Laplacian would be equal on a smooth surface; the component along the normal has
    # a sign
    mean = np.einsum("ij,ij->i", laplacian, unit(normals)) / (4.0 * safe_area)
    gauss = defect / safe_area
    return Curvature(_filled(mean, inner, edges), _filled(gauss, inner, edges), area, inner)


def _share(
    i: int,
    square: list[np.ndarray],
    cotangent: list[np.ndarray],
    cosine: list[np.ndarray],
    twice_area: np.ndarray,
) -> np.ndarray:
    """(t,) the part of each triangle at corner i: its Voronoi region, cut off in obtuse ones."""
    j, k = (i + 1) % 3, (i + 2) % 3
    voronoi = (square[j] * cotangent[j] + square[k] * cotangent[k]) / 8.0
    obtuse_here = cosine[i] < 0.0
    obtuse = obtuse_here | (cosine[j] < 0.0) | (cosine[k] < 0.0)
    return np.where(obtuse, np.where(obtuse_here, twice_area / 4.0, twice_area / 8.0), voronoi)


def _filled(values: np.ndarray, inner: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """`values` where `inner`; elsewhere the mean of the inner neighbours, or 0 if there are none."""
    a, b = edges[:, 0], edges[:, 1]
    outward = np.concatenate([edges[inner[b] & ~inner[a]], edges[inner[a] & ~inner[b]][:, ::-1]])
    total = np.bincount(outward[:, 0], weights=values[outward[:, 1]], minlength=len(values))
    number = np.bincount(outward[:, 0], minlength=len(values))
    return np.where(inner, values, total / np.maximum(number, 1))


def triangulate(
    positions: np.ndarray, corners: np.ndarray, offsets: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """((t, 3) int32 triangles, (t,) float64 weights). Polygons with fewer than 3 corners are left out,
    large ones become fans.

    A quad is cut along its shorter diagonal; if both are similar, it is cut both ways with weights.
    Otherwise curvature would depend on the order of corners, lose the mesh's symmetry, and converge one
    order slower.
    """
    sizes, first = np.diff(offsets), offsets[:-1]
    plain = corners[first[sizes == 3, None] + np.arange(3)]
    large = sizes > 4
    large_ones = corners[fans(first[large], sizes[large])[0]]
    halves, weights = _halve(positions, corners[first[sizes == 4, None] + np.arange(4)])
    triangles = np.concatenate([plain, large_ones, halves]).astype(np.int32, copy=False)
    return triangles, np.concatenate([np.ones(len(plain) + len(large_ones)), weights])


def rim_edges(arrays: ControlArrays) -> np.ndarray:
    """(e,) bool: edges where the surface is not smooth: borders, three faces or more, sharp."""
    count = arrays.edge_uses
    rim = (count == 1) | (count > 2)
    return rim if arrays.sharp_edge is None else rim | arrays.sharp_edge


def _halve(positions: np.ndarray, quads: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles and weights (t,) of (q, 4) quads; a cut outside a concave quad has weight zero."""
    a, b, c, d = (positions[quads[:, i]] for i in range(4))
    ac, bd = c - a, d - b
    normal = np.cross(ac, bd)
    inside_ac = _both_face(normal, np.cross(b - a, ac), np.cross(ac, d - a))
    inside_bd = _both_face(normal, np.cross(b - a, d - a), np.cross(c - b, bd))
    square_ac, square_bd = np.einsum("ij,ij->i", ac, ac), np.einsum("ij,ij->i", bd, bd)
    share = square_bd / np.maximum(square_ac + square_bd, np.finfo(float).tiny)
    # weight of ac: from 0 to 1 while the lengths exchange their order
    weight = np.clip(0.5 + 5.0 * (share - 0.5), 0.0, 1.0)
    weight = np.where(inside_ac == inside_bd, weight, inside_ac)
    along_ac, along_bd = weight > 0.0, weight < 1.0
    triangles = [quads[along_ac][:, half] for half in ([0, 1, 2], [0, 2, 3])]
    triangles += [quads[along_bd][:, half] for half in ([0, 1, 3], [1, 2, 3])]
    weights = [weight[along_ac]] * 2 + [1.0 - weight[along_bd]] * 2
    return np.concatenate(triangles), np.concatenate(weights)


def _both_face(normal: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return (np.einsum("ij,ij->i", normal, first) > 0.0) & (
        np.einsum("ij,ij->i", normal, second) > 0.0
    )
