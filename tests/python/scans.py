# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans whose truth is known: a blob of balls in closed form, cages around it, and noise."""

from __future__ import annotations

import numpy as np
from lattices import lattice_faces

CENTRES = np.array(
    [[-1.1, 0, 0], [-0.35, 0.25, 0.15], [0.4, 0.1, -0.1], [1.0, -0.15, 0.1], [0.1, -0.5, 0.3]]
)
RADII = np.array([0.7, 0.85, 0.8, 0.65, 0.6])
SHARPNESS = 6.0  # of the smooth union, per length


def field(points: np.ndarray) -> np.ndarray:
    """(n,) lengths, about the distance from the blob, negative inside."""
    apart = np.linalg.norm(points[:, None, :] - CENTRES, axis=2) - RADII
    return -np.log(np.exp(-SHARPNESS * apart).sum(1)) / SHARPNESS


def gradient(points: np.ndarray) -> np.ndarray:
    """(n, 3), of field()."""
    away = points[:, None, :] - CENTRES
    far = np.linalg.norm(away, axis=2)
    share = np.exp(-SHARPNESS * (far - RADII))
    share /= share.sum(1, keepdims=True)
    return ((share / far)[:, :, None] * away).sum(1)


def on_blob(points: np.ndarray, steps: int = 30) -> np.ndarray:
    """Points moved onto the blob along its gradient."""
    points = points.copy()
    for _ in range(steps):
        slope = gradient(points)
        points -= (field(points) / (slope**2).sum(1))[:, None] * slope
    return points


def normals_of_blob(points: np.ndarray) -> np.ndarray:
    slope = gradient(points)
    return slope / np.linalg.norm(slope, axis=1, keepdims=True)


def cube_sphere(pieces: int) -> tuple[np.ndarray, np.ndarray]:
    """A cube's faces in pieces² quads each, put onto the unit sphere: vertices, quads."""
    ids: dict[tuple[int, int, int], int] = {}
    quads = []
    for axis in range(3):
        for side in (0, pieces):
            for i in range(pieces):
                for j in range(pieces):
                    corners = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        at = [0, 0, 0]
                        at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3] = side, a, b
                        corners.append(ids.setdefault((at[0], at[1], at[2]), len(ids)))
                    quads.append(corners if side else corners[::-1])
    points = np.tan((np.array(list(ids)) / pieces - 0.5) * (np.pi / 2))
    return points / np.linalg.norm(points, axis=1, keepdims=True), np.array(quads)


def blob_cage(pieces: int = 6, off: float = 0.0, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A cage of 6 pieces² quads, its vertices `off` the blob along its normals."""
    sphere, quads = cube_sphere(pieces)
    points = on_blob(sphere * [1.9, 1.2, 1.1])
    random = np.random.default_rng(seed)
    return points + off * random.standard_normal((len(points), 1)) * normals_of_blob(points), quads


def blob_scan(count: int, noise: float = 0.0, seed: int = 0) -> np.ndarray:
    """(count, 3) points spread over the blob, off it by noise along its normals."""
    random = np.random.default_rng(seed)
    points = random.standard_normal((count, 3))
    points = on_blob(points / np.linalg.norm(points, axis=1, keepdims=True) * [1.9, 1.2, 1.1])
    return points + noise * random.standard_normal((count, 1)) * normals_of_blob(points)


def distance_to_blob(points: np.ndarray) -> np.ndarray:
    """(n,) lengths, to first order in the distance: exact near the blob."""
    return field(points) / np.linalg.norm(gradient(points), axis=1)


def vertex_normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    corner = points[triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    sums = np.zeros_like(points)
    for k in range(3):
        np.add.at(sums, triangles[:, k], normal)
    return sums / np.linalg.norm(sums, axis=1, keepdims=True)


def angles_to_blob(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n,) degrees, between the normals of a surface near the blob and the blob's own."""
    cosine = (vertex_normals(points, triangles) * normals_of_blob(points)).sum(1)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def sheet(along: np.ndarray, across: np.ndarray, height) -> tuple[np.ndarray, np.ndarray]:
    """The graph of a function over a grid: points and quads."""
    x, y = np.meshgrid(along, across, indexing="ij")
    return np.stack([x, y, height(x, y)], -1).reshape(-1, 3), lattice_faces(*x.shape)
