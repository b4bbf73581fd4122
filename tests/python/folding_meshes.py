# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes without a fold on which the thin plate alone makes some: each a pair (vertices (n, 3), faces)."""

import numpy as np
from lattices import lattice_faces
from scipy.spatial import Delaunay


def flat(outline):
    """One polygon with these corners (n, 2)."""
    return np.c_[np.asarray(outline, float), np.zeros(len(outline))], [list(range(len(outline)))]


def corner():
    return flat([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])


def arrow():
    return flat([(0, 0), (1, 1.5), (2, 0), (1, 2)])


def star(points: int = 5, inner: float = 0.4):
    angle = np.pi * np.arange(2 * points) / points
    radius = np.where(np.arange(2 * points) % 2, inner, 1.0)
    return flat(np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1))


def comb(teeth: int = 8):
    top = [(i + side, 10 if i % 2 == 0 else 1) for i in range(2 * teeth) for side in (0, 0.9)]
    return flat([(0, 0), *top, (2 * teeth, 0)][::-1])


def scattered(count: int = 150, seed: int = 5):
    """A Delaunay triangulation of random points in the unit square: slivers at its border."""
    points = np.random.default_rng(seed).uniform(0, 1, (count, 2))
    return np.c_[points, np.zeros(count)], Delaunay(points).simplices


def strip(width: float, faces: int = 1):
    along = np.linspace(0, 1, faces + 1)
    points = np.concatenate([np.stack([along, 0 * along + y, 0 * along], -1) for y in (0, width)])
    quads = [[i, i + 1, faces + 2 + i, faces + 1 + i] for i in range(faces)]
    return points, quads


def rounded_box(around: int = 16, apart: float = 4.0):
    """A sphere of radius 1, its octants moved apart: long faces beside tiny ones."""
    quarter, rings = around // 4, around // 2
    polar = (np.arange(rings) + 0.5) * np.pi / rings
    steps = np.concatenate([q * quarter + np.arange(quarter + 1) for q in range(4)])
    turn = 2 * np.pi * steps / around
    moved = np.repeat([[1, 1], [-1, 1], [-1, -1], [1, -1]], quarter + 1, axis=0) * apart
    points = []
    for angle in polar:
        ring = np.sin(angle) * np.stack([np.cos(turn), np.sin(turn)], -1) + moved
        height = np.cos(angle) + np.copysign(apart, np.cos(angle))
        points.append(np.c_[ring, np.full(len(ring), height)])
    size = len(turn)
    walls = lattice_faces(rings, size, (False, True))[:, [0, 2, 3, 0, 1, 2]]
    cap = []
    for q in range(4):
        start = q * (quarter + 1)
        ids = [start + k for k in range(quarter + 1)] + [(start + quarter + 1) % size]
        cap += [[ids[0], ids[k], ids[k + 1]] for k in range(1, quarter + 1)]
    cap += [[0, quarter + 1, 2 * (quarter + 1)], [0, 2 * (quarter + 1), 3 * (quarter + 1)]]
    last = size * (rings - 1)
    bottom = [[last + v for v in face[::-1]] for face in cap]
    return np.concatenate(points), np.concatenate([walls.reshape(-1, 3), cap, bottom])


def octahedron_with_a_hanging_vertex():
    """One side has a vertex that the face beside it does not have: a border loop of three vertices in a line."""
    points = np.concatenate([np.eye(3), -np.eye(3), [[0.5, 0.5, 0.0]]])
    faces = [[0, 6, 2], [6, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]]
    return points, [*faces, [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
