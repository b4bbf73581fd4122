# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes whose vertices move, for the tests of Solver."""

import control_meshes as meshes
import numpy as np
from surfaces import as_lists


def sample(name):
    """Of the control meshes: vertices (n, 3) float, and faces as lists."""
    vertices, faces = meshes.ALL[name]()
    return np.asarray(vertices, float), as_lists(faces)


def moved(points, size=0.05, seed=1):
    """The vertices, each moved at random."""
    return points + size * np.random.default_rng(seed).normal(size=points.shape)


def icosphere(subdivisions):
    """Triangles of a sphere, which is their surface of least total curvature."""
    points, faces = meshes.icosahedron()
    for _ in range(subdivisions):
        points, faces = meshes.refine_triangles(points, faces)
        points = points / np.linalg.norm(points, axis=1)[:, None]
    return points, faces
