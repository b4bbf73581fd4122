# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes of any size for timings: spheres and tori of triangles or quads, roughened as if drawn by
hand.

Each function returns (vertices (n, 3) float64, faces (m, 3) or (m, 4) int64), counter-clockwise
from outside.
"""

import numpy as np

GOLDEN = (1 + 5**0.5) / 2
ICOSAHEDRON = np.array(
    [
        *[(x, y, 0) for x in (-1, 1) for y in (-GOLDEN, GOLDEN)],
        *[(0, y, z) for y in (-1, 1) for z in (-GOLDEN, GOLDEN)],
        *[(x, 0, z) for x in (-GOLDEN, GOLDEN) for z in (-1, 1)],
    ],
    dtype=float,
)


def roughened(vertices: np.ndarray, faces: np.ndarray, share: float, seed: int = 1) -> np.ndarray:
    """Moves every vertex by up to `share` of the mean edge; the same seed gives the same moves."""
    edge = np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean()
    noise = np.random.default_rng(seed).uniform(-1, 1, vertices.shape)
    return vertices + share * edge * noise


def welded(points: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Merges points that coincide."""
    _, first, place = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    return points[first], place.reshape(-1)[faces]


def icosahedron_faces() -> np.ndarray:
    """The 20 faces: all triples at the least distance, oriented outwards."""
    distance = np.linalg.norm(ICOSAHEDRON[:, None] - ICOSAHEDRON, axis=2)
    near = (distance > 0) & (distance < 2.1)
    triples = [
        (a, b, c)
        for a in range(12)
        for b in range(a)
        for c in range(b)
        if near[a, b] and near[b, c] and near[a, c]
    ]
    faces = np.array(triples)
    corner = ICOSAHEDRON[faces]
    inward = np.einsum("ij,ij->i", np.cross(corner[:, 0], corner[:, 1]), corner[:, 2]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return faces


def sphere(m: int, rough: float = 0.15) -> tuple[np.ndarray, np.ndarray]:
    """A geodesic sphere of 20 m² triangles."""
    i, j = np.array([(i, j) for j in range(m + 1) for i in range(m + 1 - j)]).T
    place = {(a, b): k for k, (a, b) in enumerate(zip(i.tolist(), j.tolist()))}
    up = [(place[a, b], place[a + 1, b], place[a, b + 1]) for b in range(m) for a in range(m - b)]
    down = [
        (place[a + 1, b], place[a + 1, b + 1], place[a, b + 1])
        for b in range(m)
        for a in range(m - b - 1)
    ]
    cells = np.array(up + down)
    weights = np.stack([m - i - j, i, j], axis=1) / m
    points = np.einsum("pc,fcx->fpx", weights, ICOSAHEDRON[icosahedron_faces()])
    faces = cells + len(i) * np.arange(20)[:, None, None]
    vertices, faces = welded(points.reshape(-1, 3), faces.reshape(-1, 3))
    vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    return roughened(vertices, faces, rough), faces


def quad_sphere(m: int, rough: float = 0.15) -> tuple[np.ndarray, np.ndarray]:
    """A cube of 6 m² quads blown up to a sphere; equal angles between its lines."""
    t = np.tan(np.linspace(-np.pi / 4, np.pi / 4, m + 1))
    u, v = (a.reshape(-1) for a in np.meshgrid(t, t))
    one = np.ones_like(u)
    i, j = (a.reshape(-1) for a in np.meshgrid(np.arange(m), np.arange(m)))
    cell = np.stack([i, i + 1, i + m + 2, i + m + 1], axis=1) + (j * (m + 1))[:, None]
    side = {
        1: [(one, u, v), (v, one, u), (u, v, one)],
        -1: [(-one, v, u), (u, -one, v), (v, u, -one)],
    }
    points = np.concatenate([np.stack(s, axis=1) for s in side[1] + side[-1]])
    faces = np.concatenate([cell + k * len(u) for k in range(6)])
    vertices, faces = welded(points, faces)
    vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    return roughened(vertices, faces, rough), faces


def quad_torus(m: int, n: int, rough: float = 0.15) -> tuple[np.ndarray, np.ndarray]:
    """m n quads on the torus of radii √2 and 1: m round the axis, n round the tube."""
    i, j = (a.reshape(-1) for a in np.meshgrid(np.arange(m), np.arange(n), indexing="ij"))
    a, b = 2 * np.pi * i / m, 2 * np.pi * j / n
    radius = 2**0.5 + np.cos(b)
    vertices = np.stack([radius * np.cos(a), radius * np.sin(a), np.sin(b)], axis=1)
    right, up = (i + 1) % m, (j + 1) % n
    faces = np.stack([i * n + j, right * n + j, right * n + up, i * n + up], axis=1)
    return roughened(vertices, faces, rough), faces


def torus(m: int, n: int, rough: float = 0.15) -> tuple[np.ndarray, np.ndarray]:
    """The same torus of 2 m n triangles."""
    vertices, quads = quad_torus(m, n, rough)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def hull(count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """The convex hull of random points on the sphere: irregular valences, thin triangles."""
    from scipy.spatial import ConvexHull

    points = np.random.default_rng(seed).normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = ConvexHull(points).simplices.astype(np.int64)
    corner = points[faces]
    inward = np.einsum("ij,ij->i", np.cross(corner[:, 0], corner[:, 1]), corner[:, 2]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return points, faces


def fan(sides: int) -> tuple[np.ndarray, np.ndarray]:
    """Two vertices of high valence over and under a ring."""
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    vertices = np.concatenate([ring, [(0, 0, 0.5), (0, 0, -0.5)]])
    k = np.arange(sides)
    after = (k + 1) % sides
    top = np.stack([k, after, np.full(sides, sides)], axis=1)
    bottom = np.stack([after, k, np.full(sides, sides + 1)], axis=1)
    return vertices, np.concatenate([top, bottom])
