# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes of known surfaces, and holes like those of scans: connected faces, taken away at random."""

import discrete_fairing as df
import numpy as np
from lattices import lattice_faces


def largest_piece(faces):
    """(m,) bool: the faces of the largest part that edges connect."""
    owner = {}
    label = np.arange(len(faces))

    def root(k):
        while label[k] != k:
            label[k] = label[label[k]]
            k = label[k]
        return k

    for k, t in enumerate(faces.tolist()):
        for a, b in zip(t, t[1:] + t[:1], strict=True):
            other = owner.setdefault((min(a, b), max(a, b)), k)
            label[root(k)] = root(other)
    roots = np.array([root(k) for k in range(len(faces))])
    return roots == np.bincount(roots).argmax()


def ragged(faces, size, rng, wander=0.0):
    """(m,) bool: about `size` connected faces and those cut off; `wander`: next to the newest."""
    around = {}
    for k, t in enumerate(faces.tolist()):
        for v in t:
            around.setdefault(v, []).append(k)
    sides = [set() for _ in faces]
    for k, t in enumerate(faces.tolist()):
        for a, b in zip(t, t[1:] + t[:1], strict=True):
            sides[k] |= (set(around[a]) & set(around[b])) - {k}
    front = [rng.randrange(len(faces))]
    gone = set(front)
    while front and len(gone) < size:
        newest = wander > 0 and rng.random() < wander
        k = front.pop(-1 if newest else rng.randrange(len(front)))
        fresh = sorted(sides[k] - gone)
        if wander > 0:
            rng.shuffle(fresh)
        gone |= set(fresh)
        front += fresh
    found = np.zeros(len(faces), bool)
    found[list(gone)] = True
    rest = np.flatnonzero(~found)
    found[rest[~largest_piece(faces[rest])]] = True
    return found


def cut(vertices, faces, gone):
    """The mesh without the faces `gone` (m,) bool, and without loose vertices."""
    kept = faces[~gone]
    used, kept = np.unique(kept, return_inverse=True)
    return vertices[used], kept.reshape(-1, faces.shape[1])


def lattice(n, m, closed=(False, False)):
    """Triangles (t, 3) of a grid of n by m points."""
    quads = lattice_faces(n, m, closed)
    return np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])


def mapped(surface, n, m, closed=(False, False)):
    a, b = (np.linspace(0, 1, k, endpoint=not c) for k, c in zip((n, m), closed, strict=True))
    a, b = np.meshgrid(a, b, indexing="ij")
    return np.stack(surface(a.ravel(), b.ravel()), 1), lattice(n, m, closed)


def torus(n, m, tube=0.8, ring=2.0):
    def surface(a, b):
        distance = ring + tube * np.cos(2 * np.pi * b)
        x, y = distance * np.cos(2 * np.pi * a), distance * np.sin(2 * np.pi * a)
        return x, y, tube * np.sin(2 * np.pi * b)

    return mapped(surface, n, m, (True, True))


def sphere(levels=3):
    """An octahedron refined on the unit sphere."""
    vertices = np.concatenate([np.eye(3), -np.eye(3)])[[0, 3, 1, 4, 2, 5]]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(levels):
        result = df.fair(vertices, faces, levels=1)
        vertices = result.vertices / np.linalg.norm(result.vertices, axis=1)[:, None]
        faces = result.triangles.astype(np.int64)
    return vertices, np.asarray(faces)


def sheet_with_hanging_vertices(bend, triangles):
    """Eight by eight cells, of which the middle four by four are refined once."""
    ids, faces = {}, []
    for x, y in np.ndindex(8, 8):
        step = 0.5 if 2 <= min(x, y) <= max(x, y) < 6 else 1.0
        for a, b in np.ndindex(int(1 / step), int(1 / step)):
            low = x + a * step, y + b * step
            ring = [
                (low[0] + i * step, low[1] + j * step) for i, j in [(0, 0), (1, 0), (1, 1), (0, 1)]
            ]
            quad = [ids.setdefault(place, len(ids)) for place in ring]
            faces += [[*quad[:3]], [quad[0], *quad[2:]]] if triangles else [quad]
    flat = np.array(list(ids))
    return np.c_[flat, bend * ((flat - 4.0) ** 2).sum(axis=1)], faces


def saddle(a, b):
    return 2 * a - 1, 2 * b - 1, ((2 * a - 1) ** 2 - (2 * b - 1) ** 2) / 2


def quads_with_a_hole(turn=1):
    whole, all_faces = mapped(saddle, 13, 13)
    quads = all_faces.reshape(2, -1, 3)
    quads = np.concatenate([quads[0], quads[1][:, 2:]], axis=1)
    gone = np.linalg.norm(whole[quads].mean(1)[:, :2], axis=1) < 0.4
    return whole, quads[~gone][:, ::turn]


def uses(faces):
    """How many faces each edge has."""
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return np.unique(sides, axis=0, return_counts=True)[1]


def smallest_angle(vertices, faces):
    """Degrees."""
    corner = vertices[faces]
    after, before = np.roll(corner, -1, axis=1) - corner, np.roll(corner, 1, axis=1) - corner
    sine = np.linalg.norm(np.cross(after, before), axis=2)
    return np.degrees(np.arctan2(sine, (after * before).sum(axis=2))).min()
