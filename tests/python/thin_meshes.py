# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed control meshes with what CAD exports and quick modelling leave: slivers, stars, vertices that nearly
coincide. All of them are drawn by seed, so the same everywhere.

Each maker takes a random generator and returns vertices (n, 3) and faces as lists.
"""

from collections.abc import Callable, Iterator

import numpy as np
from sliver_meshes import rim_fan, zigzag

Mesh = tuple[np.ndarray, list[list[int]]]


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


def near_coincident(random) -> Mesh:
    """A torus with some vertices split in two, 1e-5 to 2e-7 of the size apart."""
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


FAMILIES: dict[str, Callable[[np.random.Generator], Mesh]] = {
    "near-coincident": near_coincident,
    "fans of slivers": sliver_fan,
    "stars": star,
}


def meshes(each: int) -> Iterator[tuple[str, str, np.ndarray, list[list[int]]]]:
    """Family, name, vertices, faces; `each` of every family."""
    for number, (family, make) in enumerate(FAMILIES.items()):
        for seed in range(each):
            points, faces = make(np.random.default_rng([number, seed]))
            yield family, f"{family}, {seed}", points, [[int(v) for v in face] for face in faces]
