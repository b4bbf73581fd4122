# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of triangle meshes in plain NumPy, without the core."""

import numpy as np


def rows_cross(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cross products of rows, and their lengths."""
    product = np.cross(a, b)
    return product, np.linalg.norm(product, axis=1)


def total_curvature(points: np.ndarray, triangles: np.ndarray) -> float:
    """∫ κ₁² + κ₂² = ∫ 4 H² − 2 K: cotangent Laplacian and angle defect, boundaries left out.

    H is measured over mixed Voronoi areas [Meyer, Desbrun, Schröder, Barr 2003], and K needs none."""
    count = len(points)
    area, defect = np.zeros(count), np.full(count, 2 * np.pi)
    laplacian = np.zeros((count, 3))
    corner = points[triangles]
    side = [corner[:, (i + 2) % 3] - corner[:, (i + 1) % 3] for i in range(3)]  # opposite corner i
    _, twice = rows_cross(side[0], side[1])
    sound = twice > 1e-14 * sum((s**2).sum(1) for s in side)
    safe = np.where(sound, twice, 1.0)
    cosine = [-(side[(i + 1) % 3] * side[(i + 2) % 3]).sum(1) for i in range(3)]
    cotangent = [np.where(sound, c / safe, 0.0) for c in cosine]
    obtuse = np.any([c < 0 for c in cosine], axis=0)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        own = triangles[:, i]
        voronoi = ((side[j] ** 2).sum(1) * cotangent[j] + (side[k] ** 2).sum(1) * cotangent[k]) / 8
        share = np.where(obtuse, np.where(cosine[i] < 0, twice / 4, twice / 8), voronoi)
        area += np.bincount(own, share, count)
        defect -= np.bincount(own, np.arctan2(twice, cosine[i]), count)
        pull = cotangent[j][:, None] * side[j] - cotangent[k][:, None] * side[k]
        for axis in range(3):
            laplacian[:, axis] += np.bincount(own, pull[:, axis], count)
    inner = area > 0
    inner[rim(triangles)] = False
    four_h2 = (laplacian[inner] ** 2).sum(1) / (4 * area[inner])  # |Δx| = 2 H, times the area
    return float(four_h2.sum() - 2 * defect[inner].sum())


def total_curvature_of_faces(points: np.ndarray, triangles: np.ndarray, quads: np.ndarray) -> float:
    """The same with quads: the mean of both ways to cut all of them."""
    cuts = (([0, 1, 2], [0, 2, 3]), ([1, 2, 3], [1, 3, 0]))
    cut = [np.concatenate([triangles, quads[:, a], quads[:, b]]).astype(np.int64) for a, b in cuts]
    return (total_curvature(points, cut[0]) + total_curvature(points, cut[1])) / 2


def rim(triangles: np.ndarray) -> np.ndarray:
    """The vertices on edges with one side."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1)
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    return np.unique(unique[uses == 1])


def turns(points: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Inner edges (k, 2), the faces (k, 2) at each, and the angles (k,) of their normals."""
    corner, size = points[faces], faces.shape[1]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, -1] - corner[:, 1])
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], -1).reshape(-1, 2), axis=1)
    order = np.lexsort(sides.T)
    sides, owner = sides[order], order // size
    twice = np.flatnonzero((sides[1:] == sides[:-1]).all(axis=1))
    pairs = np.stack([owner[twice], owner[twice + 1]], -1)
    a, b = normal[pairs].swapaxes(0, 1)
    _, sine = rows_cross(a, b)
    return sides[twice], pairs, np.arctan2(sine, (a * b).sum(1))


def dihedrals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The angles between the normals of neighbours, in degrees; faces without an area left out."""
    corner = points[triangles]
    _, length = rows_cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    return np.degrees(turns(points, triangles[length > 0])[2])
