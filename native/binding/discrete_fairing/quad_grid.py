# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads over a hole of a quad mesh: a grid between four corners of its rim."""

from __future__ import annotations

from typing import Any

import numpy as np

from .mesh_part import MeshPart, angles_between
from .near_hole import NearHole, Wanted
from .rounds import Filling

# Sums of four angles that differ by less are equal: the sides then decide between the corners.
_SAME_ANGLE = 1e-6

# Degrees. A grid with an angle out of these is no better than triangles: a quad that far from a
# rectangle is nearly a triangle, or a needle.
_LEAST_ANGLE, _MOST_ANGLE = 15.0, 165.0


def four_corners(mesh: MeshPart, loop: np.ndarray) -> tuple[int, int]:
    """The position of a grid's first corner in a loop of 2 (a + b) vertices, and a, the number of edges
    from there to the second corner.

    The four corners have the smallest sum of angles in the hole. This is the least-squares fit of right
    angles at the corners and straight angles elsewhere. Among equal sums the most similar sides win.
    """
    n, half = len(loop), len(loop) // 2
    angle = _hole_angles(mesh, loop)
    start, a = np.meshgrid(np.arange(half), np.arange(1, half), indexing="ij")
    total = sum(angle[(start + step) % n] for step in (0, a, half, half + a))
    alike = np.where(total < total.min() + _SAME_ANGLE, abs(2 * a - half), half)
    best = int(alike.argmin())
    return int(start.ravel()[best]), int(a.ravel()[best])


def _hole_angles(mesh: MeshPart, loop: np.ndarray) -> np.ndarray:
    """(n,) the angle of the hole at each vertex: a full turn less the angles of the faces there."""
    faces = mesh.touching(loop)
    corners = mesh.corners_at(faces)
    sizes = mesh.offsets[faces + 1] - mesh.offsets[faces]
    starts = np.repeat(np.cumsum(sizes) - sizes, sizes)
    place, size = np.arange(len(corners)) - starts, np.repeat(sizes, sizes)
    point = mesh.points[corners]
    to_next = point[starts + (place + 1) % size] - point
    to_last = point[starts + (place - 1) % size] - point
    used = np.zeros(len(mesh.points))
    np.add.at(used, corners, angles_between(to_next, to_last))
    return 2 * np.pi - used[loop]


def grid_of(loop: np.ndarray, points: np.ndarray, start: int, a: int, first: int) -> Any:
    """New vertices and quads inside a loop (2 (a + b),) of ids in `points`, blended bilinearly from its
    sides [Coons 1967]. New ids begin with `first`.
    """
    b = len(loop) // 2 - a
    around = np.roll(loop, -start)
    ids = np.empty((a + 1, b + 1), np.int64)
    ids[1:a, 1:b] = first + np.arange((a - 1) * (b - 1)).reshape(a - 1, b - 1)
    ids[:, 0] = around[: a + 1]
    ids[a, :] = around[a : a + b + 1]
    ids[:, b] = around[a + b : 2 * a + b + 1][::-1]
    ids[0, 1:] = around[2 * a + b :][::-1]
    u, v = np.linspace(0, 1, a + 1)[:, None, None], np.linspace(0, 1, b + 1)[None, :, None]
    p = points[np.where(ids < len(points), ids, 0)]
    across = (1 - u) * p[:1] + u * p[a:]
    along = (1 - v) * p[:, :1] + v * p[:, b:]
    corners = (1 - u) * ((1 - v) * p[0, 0] + v * p[0, b]) + u * ((1 - v) * p[a, 0] + v * p[a, b])
    quads = np.stack([ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]], -1).reshape(-1, 4)
    return (across + along - corners)[1:a, 1:b].reshape(-1, 3), quads


def quad_filling(
    mesh: MeshPart, hole: list[list[int]], wanted: Wanted, watchers: dict[str, Any]
) -> Filling | str:
    """A faired grid over the hole, whose rim runs in the direction of a face that fills it. If there is
    none, the reason as the end of a sentence.
    """
    if len(hole) > 1:
        return "it has islands"
    loop = np.array(hole[0])
    if len(loop) % 2:
        return f"its rim has {len(loop)} edges, which is odd"
    beside = mesh.touching(loop)
    if (mesh.offsets[beside + 1] - mesh.offsets[beside] != 4).any():
        return "not all faces around are quads"
    count = len(mesh.points)
    own, quads = grid_of(loop, mesh.points, *four_corners(mesh, loop), count)
    if _joins_again(mesh, loop, quads):
        return "a grid would repeat an existing edge"
    near = NearHole(mesh, own, quads, count)
    moved, made, _ = near.faired(wanted, watchers)
    least, most = _angles(near.corners(moved))
    if made.folds:
        return "a grid would fold"
    if least < _LEAST_ANGLE or most > _MOST_ANGLE:
        return f"a grid would be skew, with angles from {least:.0f} to {most:.0f} degrees"
    return Filling(moved, quads, count, made)


def _joins_again(mesh: MeshPart, loop: np.ndarray, quads: np.ndarray) -> bool:
    """Whether a side of `quads` inside the hole is an edge of the mesh."""
    count = len(mesh.points)
    known = set(map(frozenset, zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)))
    sides = np.stack([quads, np.roll(quads, -1, axis=1)], -1).reshape(-1, 2)
    inner = set(map(frozenset, sides[sides.max(axis=1) < count].tolist())) - known
    beside = mesh.corners_at(mesh.touching(loop)).reshape(-1, 4)
    theirs = np.stack([beside, np.roll(beside, -1, axis=1)], -1).reshape(-1, 2)
    return not inner.isdisjoint(map(frozenset, theirs.tolist()))


def _angles(corner: np.ndarray) -> tuple[float, float]:
    """The least and the largest angle of quads (q, 4, 3), in degrees; reflex angles count as such."""
    after, before = np.roll(corner, -1, axis=1) - corner, np.roll(corner, 1, axis=1) - corner
    found = np.degrees(angles_between(after, before)).ravel()
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    turns_in = (np.cross(after, before) * normal[:, None]).sum(axis=2).ravel() < 0.0
    found = np.where(turns_in, 360.0 - found, found)
    return float(found.min()), float(found.max())
