# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes whose sheets meet."""

import control_meshes as meshes
import numpy as np


def book(pages: int = 3, rows: int = 4, columns: int = 3, triangles: bool = False):
    """Uneven pages around a bent spine, vertices 0 … rows: (vertices, faces, faces a page)."""
    height = np.arange(rows + 1.0)
    spine = np.stack([0.2 * np.sin(height), 0.1 * height**2, height], -1)
    vertices, faces = [spine], []
    for page in range(pages):
        angle = 2 * np.pi * page / pages + 0.3
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        first = (rows + 1) * (1 + columns * page)
        at = np.arange(rows + 1) + (first - rows - 1) + (rows + 1) * np.arange(columns + 1)[:, None]
        at[0] = np.arange(rows + 1)
        for c in range(1, columns + 1):
            wave = np.stack(
                [0.2 * np.sin(c + height), 0 * height, 0.1 * np.cos(2 * c + page + 0 * height)], -1
            )
            vertices.append(spine + c * out + wave)
        quads = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4)
        faces.append(quads)
    mesh = np.concatenate(vertices), np.concatenate(faces)
    if triangles:
        mesh = meshes.cut_quads(mesh)
    return *mesh, len(mesh[1]) // pages


def alone(vertices, faces):
    """The part of a mesh with these faces, its vertices in their old order."""
    used = np.unique(faces)
    return vertices[used], np.searchsorted(used, faces)


def bulkhead():
    """A box of two cells, x from -1 to 1 to 2: (vertices, faces), the face of their wall."""
    x, y, z = np.meshgrid([-1.0, 1.0, 2.0], [0.0, 1.0], [0.0, 1.0], indexing="ij")
    vertices = np.stack([x, y, z], -1).reshape(-1, 3)
    id = np.arange(12).reshape(3, 2, 2)
    faces = [[id[0, 0, 0], id[0, 0, 1], id[0, 1, 1], id[0, 1, 0]]]
    for i in (0, 1):
        a, b = id[i], id[i + 1]
        faces += [
            [a[0, 0], b[0, 0], b[0, 1], a[0, 1]],
            [a[0, 1], b[0, 1], b[1, 1], a[1, 1]],
            [a[1, 1], b[1, 1], b[1, 0], a[1, 0]],
            [a[1, 0], b[1, 0], b[0, 0], a[0, 0]],
        ]
    end = id[2]
    faces.append([end[0, 0], end[1, 0], end[1, 1], end[0, 1]])
    wall = id[1]
    faces.append([wall[0, 0], wall[1, 0], wall[1, 1], wall[0, 1]])
    return (vertices, np.array(faces)), len(faces) - 1


def hourglass():
    """Two octahedra that touch in vertex 0, at the origin; symmetric across z = 0."""
    points, faces = meshes.octahedron()
    tip = int(np.argmax(points[:, 2]))
    lower = points - points[tip]
    others = np.delete(np.arange(6), tip)
    upper = lower * [1, 1, -1]
    ids = np.zeros((2, 6), int)
    ids[0, others], ids[1, others] = np.arange(1, 6), np.arange(6, 11)
    vertices = np.concatenate([[[0.0, 0, 0]], lower[others], upper[others]])
    return vertices, np.concatenate([ids[0][faces], ids[1][faces[:, ::-1]]])


def bow_ties():
    """Two wavy patches that touch in a corner each, vertex 0."""
    points, quads = meshes.wavy_patch(3, 3)
    points = points - points[0]
    other = np.where(quads == 0, 0, quads + len(points) - 1)
    return np.concatenate([points, -points[1:]]), np.concatenate([quads, other])
