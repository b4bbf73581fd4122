# SPDX-License-Identifier: GPL-3.0-or-later
"""Elements of meshes, and triangles of faces: plain arrays, no Blender."""

from typing import Any

import numpy as np


def fans(first: np.ndarray, sizes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fans of polygons: (t, 3) ids of corners, and (t,) polygons; `first` and `sizes` (m,)."""
    each = np.maximum(sizes - 2, 0)
    polygons = np.repeat(np.arange(len(each)), each)
    start = first[polygons] + np.arange(len(polygons)) - np.repeat(np.cumsum(each) - each, each)
    return np.stack([first[polygons], start + 1, start + 2], axis=1), polygons


def marked(ids: Any, count: int) -> np.ndarray:
    """(count,) bool: the elements with these `ids`."""
    found = np.zeros(count, bool)
    found[ids] = True
    return found


def normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n, 3) area-weighted sums of the normals of `triangles` (t, 3), at the `points`."""
    a, b, c = points[triangles].swapaxes(0, 1)
    across = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    at = triangles.ravel()
    return np.stack([np.bincount(at, across[:, k], len(points)) for k in range(3)], axis=1)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Rows of length 1; zero rows stay zero."""
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return vectors / np.where(length > 0, length, 1.0)[:, None]
