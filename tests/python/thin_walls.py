# SPDX-License-Identifier: GPL-3.0-or-later
"""Models with thin walls and fins, and how much their rims wave: the angle by which a rim turns, once around. A
flat convex rim turns by 360 degrees; each wave adds to that."""

from collections import defaultdict, deque
from collections.abc import Sequence

import discrete_fairing as df
import numpy as np
from catmull_clark import subdivide
from lattices import lattice_faces

Model = tuple[
    np.ndarray, list[list[int]], list[int]
]  # vertices, faces, the rim's vertices in order


def border(rows: int, columns: int) -> list[int]:
    """Of a grid's points, once around."""
    at = np.arange(rows * columns).reshape(rows, columns)
    around = (at[0, :-1], at[:-1, -1], at[-1, :0:-1], at[:0:-1, 0])
    return [int(v) for side in around for v in side]


def plane(rows: int, columns: int, size: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates from -1 to 1 along both sides, times half of the size."""
    x, y = np.meshgrid(np.linspace(-1, 1, rows), np.linspace(-1, 1, columns), indexing="ij")
    return size[0] / 2 * x, size[1] / 2 * y


def thickened(grid: np.ndarray, thickness: float | np.ndarray) -> Model:
    """A sheet of (rows, columns) points, as thick as that at each; its rim is that of the upper side."""
    along, across = np.gradient(grid, axis=0), np.gradient(grid, axis=1)
    normal = np.cross(along, across)
    normal *= 0.5 * np.atleast_3d(thickness) / np.linalg.norm(normal, axis=2, keepdims=True)
    rows, columns = grid.shape[:2]
    count = rows * columns
    upper = lattice_faces(rows, columns)
    rim = border(rows, columns)
    sides = [[a, b, b + count, a + count] for a, b in zip(rim, rim[1:] + rim[:1], strict=True)]
    faces = [*upper.tolist(), *(upper[:, ::-1] + count).tolist(), *sides]
    return (
        np.concatenate([(grid + normal).reshape(-1, 3), (grid - normal).reshape(-1, 3)]),
        faces,
        rim,
    )


def turned(profile: Sequence[tuple[float, float]], around: int, rim: int) -> Model:
    """A closed body of revolution, (radius, height) from bottom to top; the rim is that ring."""
    turn = 2 * np.pi * np.arange(around) / around
    rings = [
        np.stack([r * np.cos(turn), r * np.sin(turn), np.full(around, float(z))], axis=1)
        for r, z in profile
    ]
    faces = []
    for ring in range(len(profile) - 1):
        for i in range(around):
            k, low, high = (i + 1) % around, ring * around, (ring + 1) * around
            faces.append([low + i, low + k, high + k, high + i])
    last = (len(profile) - 1) * around
    faces += [list(range(around))[::-1], list(range(last, last + around))]
    return np.concatenate(rings), faces, list(range(rim * around, (rim + 1) * around))


def cup() -> Model:
    """Of 12 sides, without a handle; its lip is 3 mm of edges of 20."""
    profile = ((34, 0), (40, 6), (40, 60), (40, 95), (37, 95), (37, 60), (36, 9), (30, 4))
    return turned(profile, 12, 3)


def sheet() -> Model:
    """Bent, 2 mm of 100."""
    x, y = plane(7, 5, (100, 70))
    return thickened(np.stack([x, y, 0.004 * x**2], axis=2), 2)


def wing() -> Model:
    """Tapered and swept, 12 mm thick at the nose, 1.5 at the trailing edge."""
    x, y = plane(6, 7, (300, 100))
    chord = 0.7 - 0.3 * x / 150
    thickness = np.interp(y, (-50, -30, 50), (6, 12, 1.5)) * chord
    return thickened(np.stack([x, y * chord + 0.3 * x, 0.0002 * x**2], axis=2), thickness)


def phone_case() -> Model:
    """A tray with a wall of 1.6 mm, its corners cut."""
    x, y = plane(8, 6, (150, 76))
    outer = (np.abs(x) > 74) | (np.abs(y) > 37)
    inner = np.where(outer, 0.98, 1.0)
    corner = (np.abs(x) > 74) & (np.abs(y) > 37)
    inner = np.where(corner, 0.95, inner)
    return thickened(np.stack([x * inner, y * inner, np.where(outer, 10.0, 0.0)], axis=2), 1.6)


MODELS = {"cup": cup, "sheet": sheet, "wing": wing}


def along_edges(quads: np.ndarray, rim: list[int], pieces: int) -> list[int]:
    """The points of a refined mesh along the control edges of a rim: where rows of quads meet, the way from vertex
    to vertex that has so many steps is the only one."""
    beside: dict[int, list[int]] = defaultdict(list)
    for quad in quads.tolist():
        for a, b in zip(quad, quad[1:] + quad[:1], strict=True):
            beside[a].append(b)
            beside[b].append(a)
    points = []
    for begin, end in zip(rim, rim[1:] + rim[:1], strict=True):
        before, queue = {begin: begin}, deque([begin])
        while end not in before:
            here = queue.popleft()
            for there in beside[here]:
                if there not in before:
                    before[there] = here
                    queue.append(there)
        way = [end]
        while way[-1] != begin:
            way.append(before[way[-1]])
        assert len(way) == pieces + 1
        points += way[:0:-1]
    return points


def turning(points: np.ndarray) -> float:
    """The turn of a closed polygon, in degrees."""
    side = np.roll(points, -1, axis=0) - points
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    cosine = (side * np.roll(side, -1, axis=0)).sum(axis=1)
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1)).sum()))


def of_subdivision(model: Model, levels: int) -> float:
    """The turn of the limit surface's rim."""
    vertices, faces, rim = model
    state = (vertices, faces, {}, {})
    for _ in range(levels):
        state = subdivide(*state)
    limits = df.fair(state[0], state[1], 0, interpolation="limit").vertices
    return turning(limits[along_edges(np.array(state[1]), rim, 2**levels)])


def of_surface(model: Model, levels: int, **settings) -> float:
    """The turn of our surface's rim."""
    vertices, faces, rim = model
    found = df.fair(vertices, faces, levels, **settings)
    return turning(found.vertices[along_edges(found.faces[1], rim, 2**levels)])
