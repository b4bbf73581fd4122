# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes of thin triangles, as CAD exports and stretched scans have them: each a pair
(vertices (n, 3), faces (m, 3))."""

import numpy as np
from scipy.spatial import Delaunay


def zigzag(ring: list[int]) -> list[list[int]]:
    """A convex polygon as one strip of triangles from side to side."""
    low, high = 0, len(ring) - 1
    faces = []
    while high - low > 1:
        if (low + high) % 2:
            faces.append([ring[low], ring[low + 1], ring[high]])
            low += 1
        else:
            faces.append([ring[low], ring[high - 1], ring[high]])
            high -= 1
    return faces


def rim_fan(ring: list[int]) -> list[list[int]]:
    """A convex polygon as a fan around its first vertex."""
    return [[ring[0], ring[k], ring[k + 1]] for k in range(1, len(ring) - 1)]


def prism(sides: int = 240, height: float = 1.0, cap=zigzag, rings: int = 1):
    """A cylinder of radius 1, its walls and caps in triangles without a vertex inside a cap."""
    angle = 2 * np.pi * np.arange(sides) / sides
    around = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], -1)
    points = np.concatenate([around + [0, 0, height * k / rings] for k in range(rings + 1)])
    first = np.arange(sides * rings)
    after = first - first % sides + (first + 1) % sides
    walls = np.stack([first, after, after + sides, first, after + sides, first + sides], -1)
    top = list(range(sides * rings, sides * (rings + 1)))
    return points, np.concatenate([walls.reshape(-1, 3), cap(top), cap(list(range(sides))[::-1])])


def stretched(mesh, stretch: float):
    """A mesh made so many times as long."""
    points, faces = mesh
    return points * [1, 1, stretch], faces


def stretched_sheet(count: int = 400, stretch: float = 100.0, seed: int = 1, sheared: bool = False):
    """Random points on a wavy sheet, stretched after they were triangulated; `sheared`: triangulated
    as if they were stretched."""
    plane = np.random.default_rng(seed).uniform(size=(count, 2))
    faces = Delaunay(plane * [stretch, 1] if sheared else plane).simplices.astype(int)
    a, b, c = (plane[faces[:, k]] for k in range(3))
    clockwise = np.linalg.det(np.stack([b - a, c - a], axis=1)) < 0
    faces[clockwise] = faces[clockwise][:, ::-1]
    wave = 0.1 * np.sin(5 * plane[:, 0]) * np.cos(4 * plane[:, 1])
    return np.stack([plane[:, 0] * (1 if sheared else stretch), plane[:, 1], wave], -1), faces
