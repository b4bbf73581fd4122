# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed control meshes with what CAD exports and quick modelling leave: thin plates, bevels,
slivers, stars, vertices that nearly coincide. All of them are drawn by seed, so the same everywhere.

Each maker takes a random generator and returns vertices (n, 3) and faces as lists.
"""

from collections.abc import Callable, Iterator

import numpy as np
from sliver_meshes import rim_fan, zigzag

Mesh = tuple[np.ndarray, list[list[int]]]
EACH = 27  # meshes of a family
MOST_BEVEL = 0.4  # of the narrowest cell


def inset(outline: np.ndarray, distance: float) -> np.ndarray:
    """A polygon (n, 2), counter-clockwise, with its sides moved inwards."""
    after = np.roll(outline, -1, 0) - outline
    after /= np.linalg.norm(after, axis=1)[:, None]
    before = np.roll(after, 1, 0)
    inwards = [np.stack([-side[:, 1], side[:, 0]], -1) for side in (before, after)]
    cosine = (inwards[0] * inwards[1]).sum(1)[:, None]
    return outline + distance * (inwards[0] + inwards[1]) / (1 + cosine)


def stack(rings: list[np.ndarray], top: list[list[int]], bottom: list[list[int]] | None = None):
    """Closed polygons (n, 3) one above another, quads between them; caps as faces of one ring,
    counter-clockwise from above."""
    n, last = len(rings[0]), len(rings) - 1
    k = np.arange(n)
    after = (k + 1) % n
    faces = []
    for r in range(last):
        low, high = r * n, (r + 1) * n
        faces += np.stack([low + k, low + after, high + after, high + k], -1).tolist()
    faces += [[last * n + v for v in face] for face in top]
    faces += [face[::-1] for face in (top if bottom is None else bottom)]
    return np.concatenate(rings), faces


def chamfered(outline: np.ndarray, height: float, bevel: float, caps: list[list[int]]) -> Mesh:
    """A plate over an outline (n, 2), bevelled above and below."""
    inner = inset(outline, bevel)
    levels = [(inner, 0.0), (outline, bevel), (outline, height - bevel), (inner, height)]
    return stack([np.column_stack([ring, np.full(len(ring), z)]) for ring, z in levels], caps)


def starred(mesh: Mesh, caps: tuple[int, ...] = (-1, -2), height: float = 0.0) -> Mesh:
    """Some large faces as stars of triangles around their centres, raised by so much."""
    points, faces = mesh[0].tolist(), list(mesh[1])
    chosen = [faces[c] for c in caps]
    faces = [face for face in faces if face not in chosen]
    for face in chosen:
        corner = mesh[0][face]
        area = sum(np.cross(a, b) for a, b in zip(corner, np.roll(corner, -1, 0)))
        points.append((corner.mean(0) + height * area / np.linalg.norm(area)).tolist())
        faces += [[a, b, len(points) - 1] for a, b in zip(face, [*face[1:], face[0]])]
    return np.array(points), faces


def ellipse(sides: int, width: float = 1.0) -> np.ndarray:
    angle = 2 * np.pi * np.arange(sides) / sides
    return np.stack([np.cos(angle), width * np.sin(angle)], -1) / 2


def logarithmic(random, low: float, high: float) -> float:
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def thin_plate(random) -> Mesh:
    """A rectangle with rows of quads, bevelled on both sides."""
    m, n = random.integers(1, 6, 2)
    x, y = np.linspace(0, 1, m + 1), np.linspace(0, random.uniform(0.1, 1), n + 1)
    height = logarithmic(random, 0.002, 0.08)
    return cells(x, y, np.ones((m, n), bool), height, height * logarithmic(random, 0.02, 0.45))


def near_coincident(random) -> Mesh:
    """A torus or plate with some vertices split in two, 1e-5 to 2e-7 of the size apart."""
    if random.random() < 0.5:
        points, faces = thin_plate(random)
    else:
        points, faces = bent_torus(random)
    faces = [part for face in faces for part in ([face[:3], [face[0], *face[2:]]][: len(face) - 2])]
    size = np.linalg.norm(np.ptp(points, axis=0))
    for vertex in random.choice(len(points), min(3, len(points)), replace=False).tolist():
        gap = size * logarithmic(random, 2e-7, 1e-5)
        points, faces = split_vertex(points, faces, vertex, gap, random)
    return points, faces


def split_vertex(points, faces, vertex: int, gap: float, random) -> Mesh:
    """A vertex of triangles as two, with two slivers between them; half of its ring goes with the
    new one, which lies towards that half's middle."""
    onward = {}
    for face in faces:
        if vertex in face:
            k = face.index(vertex)
            onward[face[k - 2]] = face[k - 1]
    ring = [next(iter(onward))]
    while len(ring) < len(onward):
        ring.append(onward[ring[-1]])
    if len(ring) < 5:
        return points, faces
    start = random.integers(len(ring))
    ring = ring[start:] + ring[:start]
    taken = ring[: len(ring) // 2 + 1]
    towards = points[taken[len(taken) // 2]] - points[vertex]
    points = np.concatenate([points, [points[vertex] + gap * towards / np.linalg.norm(towards)]])
    new, both = len(points) - 1, set(zip(taken, taken[1:]))
    result = []
    for face in faces:
        if vertex in face:
            k = face.index(vertex)
            if (face[k - 2], face[k - 1]) in both:
                face = [new if v == vertex else v for v in face]
        result.append(face)
    result += [[vertex, taken[0], new], [vertex, new, taken[-1]]]
    return points, result


def bent_torus(random) -> Mesh:
    around, across = random.integers(5, 12, 2)
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    radius = 1 + random.uniform(0.1, 0.5) * np.cos(b)
    points = np.stack([radius * np.cos(a), radius * np.sin(a), 0.3 * np.sin(b)], -1)
    u1, v1 = (u + 1) % around, (v + 1) % across
    corners = [u * across + v, u1 * across + v, u1 * across + v1, u * across + v1]
    return points.reshape(-1, 3), np.stack(corners, -1).reshape(-1, 4).tolist()


def t_shape(random) -> Mesh:
    """A T of four quads, bevelled above and below; half of them with their corners cut too."""
    w, h, length = random.uniform(0.05, 0.3), random.uniform(0.1, 0.4), random.uniform(0.3, 1)
    a = w + random.uniform(0.2, 0.7)
    outline = [(-w, -length), (w, -length), (w, 0), (a, 0), (a, h), (w, h)]
    outline = np.array([*outline, (-w, h), (-a, h), (-a, 0), (-w, 0)])
    bevel = min(w, h) * logarithmic(random, 0.003, 0.3)
    height = 2 * bevel + logarithmic(random, 0.005, 0.5)
    if random.random() < 0.5:
        return chamfered(
            outline, height, bevel, [[0, 1, 2, 9], [9, 2, 5, 6], [2, 3, 4, 5], [9, 6, 7, 8]]
        )
    outline = np.delete(outline, [5, 6], 0)
    before, after = np.roll(outline, 1, 0) - outline, np.roll(outline, -1, 0) - outline
    cut = [outline + bevel * d / np.linalg.norm(d, axis=1)[:, None] for d in (before, after)]
    outline = np.stack(cut, 1).reshape(-1, 2)
    caps = [[0, 1, 2, 3, 4, 15], [15, 4, 5, 14], [14, *range(5, 14)]]
    return chamfered(outline, height, bevel * random.uniform(0.3, 1), caps)


def sliver_fan(random) -> Mesh:
    """A disk whose caps are fans or strips without a vertex inside; every other one is bevelled."""
    sides = int(random.integers(12, 120))
    outline = ellipse(sides, random.uniform(0.2, 1))
    caps = (zigzag if random.random() < 0.5 else rim_fan)(list(range(sides)))
    height = logarithmic(random, 0.003, 1)
    if random.random() < 0.5:
        return chamfered(outline, height, 0.05 * height, caps)
    rings = [np.column_stack([outline, np.full(sides, z)]) for z in (0, height)]
    return stack(rings, caps)


def star(random) -> Mesh:
    """A disk whose caps are stars of many triangles, flat or raised, with a bevel."""
    sides = int(random.integers(8, 150))
    height = logarithmic(random, 0.005, 0.5)
    plate = chamfered(
        ellipse(sides, random.uniform(0.3, 1)),
        height,
        height * logarithmic(random, 0.01, 0.4),
        [list(range(sides))],
    )
    return starred(plate, height=random.choice([0.0, 0.1, 0.3]))


def panel(random) -> Mesh:
    """A bent sheet with two sides, one edge thick."""
    m, n = random.integers(2, 11, 2)
    thickness = logarithmic(random, 3e-4, 0.05)
    points, faces = cells(
        np.linspace(0, 1, m + 1),
        np.linspace(0, random.uniform(0.3, 1), n + 1),
        np.ones((m, n), bool),
        thickness,
    )
    x, y, z = points.T
    wave = random.uniform(0, 0.2) * np.sin(random.uniform(1, 6) * x + random.uniform(0, 3) * y)
    return np.stack([x, y, z + wave], -1), faces


def long_box(random) -> Mesh:
    """A bar of square or flat section, in one piece or some, now and then in triangles."""
    pieces = int(random.integers(1, 9))
    x = np.sort(random.uniform(0, 1, pieces + 1)) if random.random() < 0.5 else None
    x = np.linspace(0, 1, pieces + 1) if x is None else (x - x[0]) / (x[-1] - x[0])
    width = logarithmic(random, 0.002, 0.1)
    y = np.array([0, width])
    height = width * random.uniform(0.1, 1)
    bevel = height * logarithmic(random, 0.02, 0.4) if random.random() < 0.5 else 0.0
    points, faces = cells(x, y, np.ones((pieces, 1), bool), height, bevel)
    if random.random() < 0.4:
        faces = [part for f in faces for part in ([f[:3], [f[0], *f[2:]]][: len(f) - 2])]
    return points, faces


def plate_with_holes(random) -> Mesh:
    """A grid of quads with some left out, none beside another; half of them bevelled."""
    m, n = 2 * random.integers(1, 4, 2) + 1
    solid = np.ones((m, n), bool)
    solid[1::2, 1::2] = random.random((m // 2, n // 2)) < 0.3
    x, y = (np.cumsum(random.uniform(0.1, 1, k + 1)) for k in (m, n))
    height = logarithmic(random, 0.005, 0.3)
    bevel = logarithmic(random, 0.02, 0.4) * min(height, 0.1) if random.random() < 0.5 else 0.0
    return cells(x / x[-1], y / y[-1], solid, height / x[-1], bevel / x[-1])


def cells(x, y, solid: np.ndarray, height: float, bevel: float = 0.0) -> Mesh:
    """Cells of a grid as a plate with two sides and a wall; with a bevel, its rims are moved
    inwards above and below. `solid` (len(x) - 1, len(y) - 1): the cells there are."""
    bevel = min(bevel, MOST_BEVEL * min(np.diff(x).min(), np.diff(y).min()))
    number: dict[tuple, int] = {}
    faces, walls = [], {}
    for i, j in zip(*np.nonzero(solid)):
        around = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        faces.append([number.setdefault(("top", *p), len(number)) for p in around])
        faces.append([number.setdefault(("bottom", *p), len(number)) for p in around[::-1]])
        for p, q in zip(around, [*around[1:], around[0]]):
            walls[p, q] = (q, p) not in walls
            if (q, p) in walls:
                walls[q, p] = False
    levels = ["bottom", "low", "high", "top"] if bevel else ["bottom", "top"]
    turn = {}  # at a vertex of the rim: where the two sides there lead in, added up
    for (p, q), outer in walls.items():
        if not outer:
            continue
        inwards = np.sign(np.array([p[1] - q[1], q[0] - p[0]], float))
        for r in (p, q):
            turn.setdefault(r, []).append(inwards)
        for low, high in zip(levels, levels[1:]):
            faces.append(
                [
                    number.setdefault((side, *r), len(number))
                    for side, r in ((low, p), (low, q), (high, q), (high, p))
                ]
            )
    points = np.empty((len(number), 3))
    heights = {"bottom": 0.0, "low": bevel, "high": height - bevel, "top": height}
    for (side, i, j), v in number.items():
        points[v] = x[i], y[j], heights[side]
        if bevel and side in ("top", "bottom") and (i, j) in turn:
            one, two = turn[i, j]
            points[v, :2] += bevel * (one if (one == two).all() else one + two)
    return points, faces


FAMILIES: dict[str, Callable[[np.random.Generator], Mesh]] = {
    "thin plates": thin_plate,
    "near-coincident": near_coincident,
    "T-shaped": t_shape,
    "fans of slivers": sliver_fan,
    "stars": star,
    "panels": panel,
    "long boxes": long_box,
    "plates with holes": plate_with_holes,
}


def meshes(each: int = EACH) -> Iterator[tuple[str, str, np.ndarray, list[list[int]]]]:
    """Family, name, vertices, faces; `each` of every family."""
    for number, (family, make) in enumerate(FAMILIES.items()):
        for seed in range(each):
            points, faces = make(np.random.default_rng([number, seed]))
            yield family, f"{family}, {seed}", points, [[int(v) for v in face] for face in faces]
