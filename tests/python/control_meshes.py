# SPDX-License-Identifier: GPL-3.0-or-later
"""Small control meshes that the project makes itself: each a pair (vertices (n, 3), faces (m, 3 | 4) or a list)."""

import numpy as np
from lattices import lattice_faces
from scipy.spatial import ConvexHull


def hull(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The convex hull of points that all lie on it, its triangles counter-clockwise from outside."""
    faces = ConvexHull(points).simplices.astype(int)
    corner = points[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    inward = np.einsum("fi,fi->f", normal, corner.mean(1) - points.mean(0)) < 0
    faces[inward] = faces[inward][:, ::-1]
    return points, faces


def icosahedron():
    """On the unit sphere."""
    golden = (1 + 5**0.5) / 2
    one = np.array([[0, s, t * golden] for s in (1, -1) for t in (1, -1)])
    points = np.concatenate([one, one[:, [1, 2, 0]], one[:, [2, 0, 1]]])
    return hull(points / np.linalg.norm(points[0]))


def octahedron():
    """On the unit sphere."""
    return hull(np.concatenate([np.eye(3), -np.eye(3)]))


def tetrahedron():
    """On the unit sphere: every valence is three."""
    return hull(np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / 3**0.5)


def random_hull(count: int = 20, seed: int = 1):
    """Random points of the unit sphere."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return hull(points / np.linalg.norm(points, axis=1)[:, None])


def cube():
    """Six quads, side 2."""
    points = np.array([[x, y, z] for z in (-1.0, 1) for y in (-1, 1) for x in (-1, 1)])
    return points, np.array(
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    )


def cut_quads(mesh):
    """Every quad as two triangles."""
    points, quads = mesh
    return points, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def torus(around: int = 8, across: int = 6, radius: float = 2**0.5):
    """Quads on the torus of small radius 1."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    ring = radius + np.cos(b)
    points = np.stack([ring * np.cos(a), ring * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    return points, lattice_faces(around, across, (True, True))


def grid(columns: int = 4, rows: int = 4):
    """A flat sheet of unit squares; vertex (i, j) is number j * (columns + 1) + i."""
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    points = np.stack([x, y, np.zeros_like(x)], -1).reshape(-1, 3)
    return points, lattice_faces(rows + 1, columns + 1)[:, [0, 3, 2, 1]]


def wavy_patch(columns: int = 4, rows: int = 4, height: float = 0.7):
    """Triangles over a sheet with a boundary, up and down."""
    points, quads = grid(columns, rows)
    points[:, 2] = height * np.sin(1.3 * points[:, 0] + 0.4) * np.cos(0.9 * points[:, 1])
    return cut_quads((points, quads))


def flat_patch(seed: int = 3):
    """Irregular triangles in the plane z = 0, with a boundary."""
    points, quads = grid(4, 4)
    inner = np.all((points[:, :2] > 0) & (points[:, :2] < 4), axis=1)
    points[inner, :2] += np.random.default_rng(seed).uniform(-0.3, 0.3, (inner.sum(), 2))
    return cut_quads((points, quads))


def fan(count: int, height: float = 0.3):
    """Triangles around vertex 0, with a boundary; at least three."""
    angle = 2 * np.pi * np.arange(count) / count
    rim = np.stack([np.cos(angle), np.sin(angle), 0.1 * np.cos(3 * angle)], -1)
    k = np.arange(count)
    return np.concatenate([[[0, 0, height]], rim]), np.stack(
        [np.zeros_like(k), k + 1, (k + 1) % count + 1], -1
    )


def closed_pole(count: int = 360):
    """A double cone: two vertices of that valence, rounded by a ring between."""
    angle = 2 * np.pi * np.arange(count) / count
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], -1)
    k = np.arange(count)
    after = (k + 1) % count
    north, south = np.full(count, count), np.full(count, count + 1)
    faces = np.concatenate([np.stack([k, after, north], -1), np.stack([after, k, south], -1)])
    return np.concatenate([rim, [[0, 0, 0.8], [0, 0, -0.8]]]), faces


def single_triangle():
    """One face, all boundary."""
    return np.array([[0.0, 0, 0], [1, 0, 0.1], [0.2, 0.9, 0]]), np.array([[0, 1, 2]])


def dodecahedron():
    """Twelve pentagons, as a list."""
    points, triangles = icosahedron()
    centres = points[triangles].mean(1)
    centres /= np.linalg.norm(centres, axis=1)[:, None]
    faces = []
    for v, axis in enumerate(points):
        ring = np.nonzero((triangles == v).any(1))[0]
        right = centres[ring[0]] - axis * (centres[ring[0]] @ axis)
        up = np.cross(axis, right)
        faces.append(
            ring[np.argsort(np.arctan2(centres[ring] @ up, centres[ring] @ right))].tolist()
        )
    return centres, faces


def mixed_house():
    """Five quads, a pentagon wall either side, a roof of quad and triangles: every size of face, closed."""
    points = [[x, y, z] for z in (0, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    points += [[0, -1, 1.7], [0, 1, 1.7]]
    faces = [[3, 2, 1, 0], [0, 1, 5, 8, 4], [2, 3, 7, 9, 6], [1, 2, 6, 5], [3, 0, 4, 7]]
    faces += [[5, 6, 9, 8], [7, 4, 8], [7, 8, 9]]
    return np.array(points, float), faces


def roof(columns: int = 4, slope: float = 0.8):
    """Two wavy slopes of quads that meet in a straight ridge x = 0, and the ridge's edges."""
    points, quads = grid(2 * columns, 4)
    points[:, 0] -= columns
    x, y = points[:, 0].copy(), points[:, 1]
    points[:, 2] = -slope * np.abs(x) + 0.15 * np.sin(1.7 * np.abs(x)) * np.cos(1.1 * y) * np.abs(x)
    ridge = np.nonzero(x == 0)[0]
    return (points, quads), np.stack([ridge[:-1], ridge[1:]], -1)


def box_with_creases():
    """A box of 24 quads whose twelve sides are creases (each of two edges)."""
    points, quads = cube()
    points, quads = refine_quads(points, quads)
    edges, _ = edges_of(quads)
    middle = points[edges].mean(1)
    return (points, quads), edges[(np.abs(np.abs(middle) - 1) < 1e-12).sum(1) == 2]


def edges_of(polygons):
    """Edges of polygons of one size, lower vertex first, and the edge of each of their sides."""
    size = polygons.shape[1]
    sides = np.concatenate([polygons[:, [k, (k + 1) % size]] for k in range(size)])
    edges, number = np.unique(np.sort(sides, 1), axis=0, return_inverse=True)
    return edges, number.reshape(size, -1).T


def refine_quads(points, quads):
    """One linear refinement."""
    edges, side = edges_of(quads)
    side = side + len(points)
    centre = len(points) + len(edges) + np.arange(len(quads))
    parts = [np.stack([quads[:, k], side[:, k], centre, side[:, k - 1]], -1) for k in range(4)]
    return np.concatenate([points, points[edges].mean(1), points[quads].mean(1)]), np.concatenate(
        parts
    )


def drum(count: int = 8):
    """A closed can whose rim is a crease loop: (mesh, loop (k, 2), vertices above, vertices below)."""
    angle = 2 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], -1)
    rings = np.concatenate(
        [ring, 0.6 * ring + [0, 0, 0.3], 1.05 * ring - [0, 0, 1], 0.5 * ring - [0, 0, 1.5]]
    )
    points = np.concatenate([rings, [[0, 0, 0.4], [0, 0, -1.6]]])
    k = np.arange(count)
    after = (k + 1) % count
    top, bottom = np.full(count, 4 * count), np.full(count, 4 * count + 1)

    def band(low, high):
        lower = np.stack([low + k, low + after, high + after], -1)
        return np.concatenate([lower, np.stack([low + k, high + after, high + k], -1)])

    caps = [
        np.stack([count + k, count + after, top], -1),
        np.stack([3 * count + after, 3 * count + k, bottom], -1),
    ]
    faces = np.concatenate([band(0, count), band(2 * count, 0), band(3 * count, 2 * count), *caps])
    above = np.append(np.arange(count, 2 * count), 4 * count)
    below = np.append(np.arange(2 * count, 4 * count), 4 * count + 1)
    return (points, faces), np.stack([k, after], -1), above, below


def creature(seed: int = 5):
    """Irregular, closed, of quads and triangles, mirror-symmetric in x to the last bit."""
    points, quads = cube()
    for _ in range(2):
        points, quads = refine_quads(points, quads)
    points = points * [1.0, 1.5, 0.8]
    points += 0.35 * points / np.linalg.norm(points, axis=1)[:, None]
    random = np.random.default_rng(seed)
    key = {tuple(p): k for k, p in enumerate(points + 0.0)}
    image = np.array([key[(-x + 0.0, y, z)] for x, y, z in points])
    jitter = random.uniform(-0.12, 0.12, points.shape)
    right = points[:, 0] > 0
    jitter[~right & (points[:, 0] < 0)] = 0
    jitter[points[:, 0] == 0, 0] = 0
    jitter[image[right]] = jitter[right] * [-1, 1, 1]
    points = points + jitter
    faces, number = [], {tuple(sorted(q)): k for k, q in enumerate(quads.tolist())}
    chosen = set(
        random.choice(np.nonzero(points[quads].mean(1)[:, 0] > 0)[0], 12, replace=False).tolist()
    )
    opposite = {number[tuple(sorted(image[q].tolist()))]: k for k, q in enumerate(quads.tolist())}
    for k, quad in enumerate(quads.tolist()):
        if k in chosen:
            faces += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
        elif opposite[k] in chosen:
            a, b, c, d = image[quads[opposite[k]]].tolist()
            faces += [[c, b, a], [d, c, a]]
        else:
            faces.append(quad)
    return points, faces


def rough_ball(seed: int = 3, roughness: float = 0.5):
    """A sphere of 128 triangles with vertices off it at random, folded by over 90 degrees."""
    points, faces = octahedron()
    for _ in range(2):
        points, faces = refine_triangles(points, faces)
    points = points / np.linalg.norm(points, axis=1)[:, None]
    random = np.random.default_rng(seed)
    points = points * (1 + roughness * random.uniform(-1, 1, len(points)))[:, None]
    return points + 0.3 * roughness * random.uniform(-1, 1, points.shape), faces


def refine_triangles(points, triangles):
    """One linear refinement."""
    edges, side = edges_of(triangles)
    side = side + len(points)
    parts = [np.stack([triangles[:, k], side[:, k], side[:, k - 1]], -1) for k in range(3)]
    return np.concatenate([points, points[edges].mean(1)]), np.concatenate([*parts, side])


def three_handles():
    """Quads of genus 3: the surface of a thick lattice of 7 x 3 x 1 blocks with three holes."""
    solid = {(i, j) for i in range(7) for j in range(3)} - {(1, 1), (3, 1), (5, 1)}
    number, quads = {}, []

    def corner(*at):
        return number.setdefault(at, len(number))

    for i, j in sorted(solid):
        around = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        quads.append([corner(*p, 1) for p in around])
        quads.append([corner(*p, 0) for p in reversed(around)])
        for side, (di, dj) in enumerate([(0, -1), (1, 0), (0, 1), (-1, 0)]):
            if (i + di, j + dj) not in solid:
                p, q = around[side], around[(side + 1) % 4]
                quads.append([corner(*p, 0), corner(*q, 0), corner(*q, 1), corner(*p, 1)])
    points = np.array(sorted(number, key=number.get), float)
    points[:, :2] += 0.1 * np.sin(np.arange(2 * len(points)).reshape(-1, 2))
    return points, np.array(quads)


# quads, triangles and a pentagon, with a border: a house without its floor
HOUSE = (
    np.array(
        [[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0], [0, 0, 2], [2, 0, 2], [2, 3, 2], [0, 3, 2], [1, 0, 3], [1, 3, 3]],
        float,
    ),
    [[0, 1, 5, 8, 4], [2, 3, 7, 9, 6], [1, 2, 6, 5], [3, 0, 4, 7], [5, 6, 9, 8], [4, 8, 9], [4, 9, 7]],
)  # fmt: skip

CLOSED = {
    "icosahedron": icosahedron,
    "octahedron": octahedron,
    "tetrahedron": tetrahedron,
    "random_hull": random_hull,
    "cube": cube,
    "torus_quads": torus,
    "torus_triangles": lambda: cut_quads(torus()),
    "dodecahedron": dodecahedron,
    "house": mixed_house,
    "creature": creature,
    "three_handles": three_handles,
}
OPEN = {
    "grid": grid,
    "wavy_patch": wavy_patch,
    "fan3": lambda: fan(3),
    "fan8": lambda: fan(8),
    "roof": lambda: roof()[0],
    "single_triangle": single_triangle,
}
ALL = CLOSED | OPEN
