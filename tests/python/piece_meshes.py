# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes to be cut into pieces, each with settings: (vertices, faces, settings)."""

import control_meshes as meshes
import numpy as np
import one_sided_meshes
import sheet_meshes
from lattices import lattice_faces


def torus(around=24, across=12, noise=0.0, triangles=False):
    points, faces = meshes.torus(around, across, 2 / 0.7)
    points = 0.7 * points + noise * np.random.default_rng(3).normal(size=points.shape)
    return meshes.cut_quads((points, faces)) if triangles else (points, faces)


def sheet(rows=16, columns=14, stretched=False):
    """A sheet with a border; with `stretched`, its columns become wider from left to right."""
    x, y = np.meshgrid(np.arange(rows) / 4.0, np.arange(columns) / 4.0, indexing="ij")
    height = 0.3 * np.sin(2 * x) * np.cos(3 * y)
    if stretched:
        y = 0.2 * y + 0.3 * y**2
    return np.stack([x, y, height], -1).reshape(-1, 3), lattice_faces(rows, columns)


def ring(around=24, across=12, every=1):
    """The edges of a torus' outermost circle."""
    start = np.arange(0, around, every) * across
    return np.stack([start, (start + across) % (around * across)], 1)


def hexagons(around=24, across=12):
    points, _ = torus(around, across)
    at = np.arange(around * across).reshape(around, across)
    faces = []
    for i in range(0, around, 2):
        rows = [at[(i + k) % around] for k in range(3)]
        for j in range(across):
            k = (j + 1) % across
            faces.append([rows[0][j], rows[1][j], rows[2][j], rows[2][k], rows[1][k], rows[0][k]])
    return points, faces


def with_defects():
    """A mesh with a duplicate face, a flipped face, a seam of duplicate vertices and a vertex far away."""
    points, faces = torus()
    faces = np.concatenate([faces, faces[5:6]])
    faces[40] = faces[40, ::-1]
    seam = np.arange(12)
    first = np.isin(faces, seam) & (np.arange(len(faces)) < 12)[:, None]
    faces = np.where(first, faces + len(points), faces)
    return np.concatenate([points, points[:12], [[9.0, 9, 9]]]), faces


MESHES = {
    "torus": (*torus(), {}),
    "noisy triangles": (*torus(noise=0.02, triangles=True), {}),
    "closed crease": (*torus(), {"crease_edges": ring()}),
    "open creases and corners": (
        *torus(),
        {"crease_edges": ring()[:15], "corner_vertices": [12 * 6, 5]},
    ),
    "folded": (*torus(across=8), {"crease_angle": 0.6}),
    "border": (*sheet(), {}),
    "straight and free border": (
        *sheet(),
        {"boundary": "linear", "boundary_edges": {"free": [(i, i + 1) for i in range(13)]}},
    ),
    "book": (*sheet_meshes.book(rows=14, columns=6)[:2], {}),
    "triangle book": (*sheet_meshes.book(rows=14, columns=6, triangles=True)[:2], {}),
    "split polygons": (*hexagons(), {}),
    "one-sided": (*one_sided_meshes.strip(24, 4), {}),
    "defects": (*with_defects(), {"repair": "mend", "weld": 0}),
}
