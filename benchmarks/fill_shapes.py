# SPDX-License-Identifier: GPL-3.0-or-later
"""Known surfaces with a hole, and distances of points from them."""

from collections.abc import Callable
from dataclasses import dataclass

import control_meshes
import numpy as np

Distance = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Holed:
    vertices: np.ndarray  # (n, 3)
    faces: np.ndarray  # (m, 3)
    hole: np.ndarray  # (k,) ids around it
    distance: Distance  # of points (p, 3) from the surface
    gone: np.ndarray  # (g, 3, 3) corners of the triangles that were taken away

    @property
    def diameter(self) -> float:
        rim = self.vertices[self.hole]
        return float(np.linalg.norm(rim[:, None] - rim[None], axis=2).max())


def turns_at_edges(
    points: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The two triangles of each inner edge, and the degrees between their normals."""
    corner = points[triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(triangles)), 3)
    order = np.lexsort(sides.T)
    sides, owner = sides[order], owner[order]
    same = np.flatnonzero((sides[1:] == sides[:-1]).all(axis=1))
    a, b = owner[same], owner[same + 1]
    return a, b, np.degrees(np.arccos((normal[a] * normal[b]).sum(axis=1).clip(-1, 1)))


def lattice(n: int, m: int, closed: tuple[bool, bool]) -> np.ndarray:
    """Triangles (t, 3) of a grid of n by m points."""
    at = np.arange(n * m).reshape(n, m)
    right, up = np.roll(at, -1, axis=0), np.roll(at, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    keep = np.s_[: n - (not closed[0]), : m - (not closed[1])]
    cells = [np.stack([at, right, both], -1)[keep], np.stack([at, both, up], -1)[keep]]
    return np.concatenate([c.reshape(-1, 3) for c in cells])


def _holed(points: np.ndarray, faces: np.ndarray, gone: np.ndarray, distance: Distance) -> Holed:
    import discrete_fairing as df

    used, kept = np.unique(faces[~gone], return_inverse=True)
    vertices, kept = points[used], kept.reshape(-1, 3)
    centre = points[faces[gone]].mean((0, 1))
    loops = df.find_holes(vertices, kept)
    near = [np.linalg.norm(vertices[loop].mean(0) - centre) for loop in loops]
    hole = loops[int(np.argmin(near))]
    return Holed(vertices, kept, hole, distance, points[faces[gone]])


def _sphere(height: float) -> Holed:
    points, faces = control_meshes.sphere(16, rough=0.0)
    gone = (points[faces][:, :, 2] > height - 1e-9).all(axis=1)
    return _holed(points, faces, gone, lambda p: abs(np.linalg.norm(p, axis=1) - 1))


def _tube(chosen: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Holed:
    angle, height = np.meshgrid(
        np.linspace(0, 2 * np.pi, 72, endpoint=False), np.linspace(-2, 2, 47), indexing="ij"
    )
    points = np.stack([np.cos(angle), np.sin(angle), height], -1).reshape(-1, 3)
    faces = lattice(72, 47, (True, False))
    x, y, z = points[faces].mean(1).T
    gone = chosen(np.arctan2(y, x), z)
    return _holed(points, faces, gone, lambda p: abs(np.hypot(p[:, 0], p[:, 1]) - 1))


def _torus() -> Holed:
    """A quarter of the ring, without the outer half of its tube."""
    n, m, tube = 96, 36, 0.7
    a, b = np.meshgrid(
        *(np.linspace(0, 2 * np.pi, k, endpoint=False) for k in (n, m)), indexing="ij"
    )
    away = 2 + tube * np.cos(b)
    points = np.stack([away * np.cos(a), away * np.sin(a), tube * np.sin(b)], -1).reshape(-1, 3)
    faces = lattice(n, m, (True, True))
    x, y, _ = points[faces].mean(1).T
    gone = (abs(np.arctan2(y, x)) < np.pi / 4) & (np.hypot(x, y) > 2)
    return _holed(
        points,
        faces,
        gone,
        lambda p: abs(np.hypot(np.hypot(p[:, 0], p[:, 1]) - 2, p[:, 2]) - tube),
    )


def _graph(sign: float) -> Holed:
    line = np.linspace(-1, 1, 41)
    x, y = np.meshgrid(line, line, indexing="ij")
    points = np.stack([x, y, (x**2 + sign * y**2) / 2], -1).reshape(-1, 3)
    faces = lattice(41, 41, (False, False))
    gone = np.linalg.norm(points[faces].mean(1)[:, :2], axis=1) < 0.5

    def distance(p: np.ndarray) -> np.ndarray:
        """Distances to first order, which are upper bounds here, because the slope is below one."""
        x, y, z = p.T
        return abs(z - (x**2 + sign * y**2) / 2) / np.sqrt(1 + x**2 + y**2)

    return _holed(points, faces, gone, distance)


SHAPES: dict[str, Callable[[], Holed]] = {
    "half sphere": lambda: _sphere(0.0),
    "60° cap": lambda: _sphere(0.5),
    "cylinder side": lambda: _tube(lambda a, z: a**2 + z**2 < 0.5),
    "torus, bite": _torus,
    "saddle": lambda: _graph(-1.0),
    "paraboloid": lambda: _graph(1.0),
    "cylinder, 220°": lambda: _tube(lambda a, z: (abs(a) < np.radians(110)) & (abs(z) < 0.5)),
}
