# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin triangles, as of CAD exports and stretched scans: (vertices (n, 3), faces (m, 3))."""

import numpy as np
from lattices import lattice_faces
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
    walls = lattice_faces(rings + 1, sides, (False, True))[:, [0, 3, 2, 0, 2, 1]]
    top = list(range(sides * rings, sides * (rings + 1)))
    return points, np.concatenate([walls.reshape(-1, 3), cap(top), cap(list(range(sides))[::-1])])


def stretched(mesh, stretch: float):
    """A mesh made so many times as long."""
    points, faces = mesh
    return points * [1, 1, stretch], faces


def stretched_sheet(count: int = 400, stretch: float = 100.0, seed: int = 1, sheared: bool = False):
    """Random points on a wavy sheet, stretched after triangulation, or before if `sheared`."""
    plane = np.random.default_rng(seed).uniform(size=(count, 2))
    faces = Delaunay(plane * [stretch, 1] if sheared else plane).simplices.astype(int)
    a, b, c = (plane[faces[:, k]] for k in range(3))
    clockwise = np.linalg.det(np.stack([b - a, c - a], axis=1)) < 0
    faces[clockwise] = faces[clockwise][:, ::-1]
    wave = 0.1 * np.sin(5 * plane[:, 0]) * np.cos(4 * plane[:, 1])
    return np.stack([plane[:, 0] * (1 if sheared else stretch), plane[:, 1], wave], -1), faces


def height_of_dome(flat):
    return 0.6 * np.exp(-3 * (flat**2).sum(axis=1))


def dome_of_rings(count):
    """A dome of radius 1 through its pole and four rings of `count` points each."""
    radii = (1, 0.75, 0.5, 0.25)
    angle = 2 * np.pi * (np.arange(count) + 0.5 * np.arange(4)[:, None]) / count
    flat = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * np.reshape(radii, (4, 1, 1))
    flat = np.concatenate([flat.reshape(-1, 2), [(0, 0)]])
    k, after = np.arange(count), np.roll(np.arange(count), -1)
    faces = [np.c_[3 * count + k, 3 * count + after, np.full(count, 4 * count)]]
    for outer in count * np.arange(3):
        inner = outer + count
        faces += [np.c_[outer + k, outer + after, inner + k]]
        faces += [np.c_[inner + k, outer + after, inner + after]]
    return np.c_[flat, height_of_dome(flat)], np.concatenate(faces)
