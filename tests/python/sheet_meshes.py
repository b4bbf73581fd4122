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
    """A box of two cells, x from -1 to 1 and from 1 to 2, with the wall between them: (vertices,
    faces), the wall's face."""
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


def mirrored_book(seed: int = 4):
    """Two pairs of crumpled pages, each other's mirror images across x = 0, at a spine in x = 0."""
    vertices, faces, size = book(4, rows=3, columns=3)
    vertices = vertices + np.random.default_rng(seed).uniform(-0.2, 0.2, vertices.shape)
    vertices[:4, 0] = 0
    page = np.arange(12).reshape(3, 4)
    right, left = [np.concatenate([np.arange(4), 4 + page.ravel() + 12 * k]) for k in (0, 1)]
    for up in (0, 24):
        points = vertices[right[4:] + up]
        points[:, 0] = 0.3 + np.abs(points[:, 0]) + np.repeat([0.5, 1.5, 2.5], 4)
        points[:, 1] += 3 if up else -3
        vertices[right[4:] + up] = points
        vertices[left[4:] + up] = points * [-1, 1, 1]
    image = np.empty(len(vertices), int)
    image[:4] = np.arange(4)
    for up in (0, 24):
        image[right[4:] + up], image[left[4:] + up] = left[4:] + up, right[4:] + up
    for first in (0, 2 * size):
        faces[first + size : first + 2 * size] = image[faces[first : first + size, ::-1]]
    return vertices, faces


def mirrored_book_with_a_wall(seed: int = 4):
    """The same with a fifth page, uneven but in x = 0: (vertices, faces, faces of the wall)."""
    vertices, faces = mirrored_book(seed)
    size = len(faces) // 4
    out = np.arange(1, 4)[:, None, None] * [0.0, 1.1, 0.2] + vertices[:4]
    out += np.random.default_rng(seed).uniform(-0.3, 0.3, out.shape) * [0, 1, 1]
    at = np.concatenate([[np.arange(4)], np.arange(12).reshape(3, 4) + len(vertices)])
    wall = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4)
    assert len(wall) == size
    mesh = np.concatenate([vertices, out.reshape(-1, 3)]), np.concatenate([faces, wall])
    return *mesh, np.arange(size) + 4 * size
