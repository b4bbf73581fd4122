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
    """Each vertex elsewhere, at random."""
    return points + size * np.random.default_rng(seed).normal(size=points.shape)


def icosphere(subdivisions):
    """A sphere's triangles, so that its surface of least total curvature is known."""
    vertices, faces = sample("icosahedron")
    points, triangles = [p / np.linalg.norm(p) for p in vertices], faces
    for _ in range(subdivisions):
        middle, finer = {}, []

        def between(a, b, middle=middle):
            key = (min(a, b), max(a, b))
            if key not in middle:
                p = points[a] + points[b]
                middle[key] = len(points)
                points.append(p / np.linalg.norm(p))
            return middle[key]

        for a, b, c in triangles:
            x, y, z = between(a, b), between(b, c), between(c, a)
            finer += [[a, x, z], [b, y, x], [c, z, y], [x, y, z]]
        triangles = finer
    return np.array(points), np.array(triangles)


def slid(points, size, seed):
    """The same sphere with its vertices elsewhere on it."""
    p = moved(points, size, seed)
    return p / np.linalg.norm(p, axis=1)[:, None]
