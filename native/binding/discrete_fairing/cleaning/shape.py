# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps that move vertices: they flatten spikes and folded faces, and move faces back that noise, or a pressed spike, has
pushed through faces next to them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import _native
from ..arrays import connected_parts, marked, ranges
from ..mesh_part import MeshPart, angles_between
from .state import State

# Times that vertices move to their neighbours' mean; spikes of several vertices need more.
ROUNDS = 10
# Faces agree if their normals have a mean at least so long: that of normals within an eighth of a turn of it.
AGREE = np.sqrt(0.5)


def flattened(
    state: State, fixed: np.ndarray, spikes: bool, folds: bool, filled: bool = False
) -> tuple[State, int, int]:
    """The state with spikes and folded faces flattened, and the numbers of both. Tips of spikes, where the
    angles of the faces sum to less than half a turn, and corners of faces whose normals are opposite to
    all faces around move to the mean of their neighbours, unless the surface closes there, as at the tip of a
    cone. Vertices `fixed`, (n,) bool, stay. `filled`: only the rims of filled holes are
    examined again, where folded faces need not agree around others.
    """
    lone = state.sides.uses[state.sides.edge] != 2
    rim = marked(state.sides.ends[lone], len(state.points))
    mesh = MeshPart.of(state.points, state.corners, state.offsets)
    free = ~rim & ~fixed
    points = state.points.copy()
    near = np.arange(len(state.face_origin))
    if filled:
        near = _around(mesh, mesh.corners_at(np.flatnonzero(state.face_origin < 0)))
    tips = np.zeros(len(points), bool)
    folded: np.ndarray = np.empty(0, np.int64)
    for turn in range(ROUNDS):
        fans = _Fans(state, points, near)
        sharp = fans.sharp(free) & spikes
        bad = sharp.copy()
        if folds:
            over = fans.folded(agree=not filled)
            if turn == 0:
                folded = over
            bad[fans.vertices_of(over)] = True
        bad &= free
        if turn == 0 and bad.any():
            bad &= ~_closes(state, points, rim)
        tips |= sharp & bad
        if not bad.any():
            break
        points = in_the_middle(state, points, bad)
        near = _around(mesh, bad)
    if (points == state.points).all():
        return state, 0, 0
    moved = (points != state.points).any(axis=1)
    mended = sum(
        bool(moved[state.corners[state.offsets[f] : state.offsets[f + 1]]].any()) for f in folded
    )
    return state.replaced(points=points), int((tips & moved).sum()), mended


def _closes(state: State, points: np.ndarray, rim: np.ndarray) -> np.ndarray:
    """(n,) whether the angles missing at a vertex and its neighbours sum to a quarter of a turn, and to two
    thirds of those at the vertex, as at the tip of a cone. The sum is the surface's curvature there [Gauss
    and Bonnet]; a spike does not change it, and noise changes it by up to half of a spike's.
    """
    a, b, c = state.triangles().T
    missing = np.where(rim, np.pi, 2.0 * np.pi)
    for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
        missing -= np.bincount(
            i, angles_between(points[j] - points[i], points[k] - points[i]), len(points)
        )
    ways = np.concatenate([[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]], axis=1)
    ways = np.unique(ways[0] * np.int64(len(points)) + ways[1])
    begin, end = np.divmod(ways, len(points))
    around = missing + np.bincount(begin, missing[end], len(points))
    return around >= np.maximum(2.0 / 3.0 * missing, 0.5 * np.pi)


class _Fans:
    """Angles and normals around vertices, from a subset of faces; valid for vertices with no others."""

    def __init__(self, state: State, points: np.ndarray, faces: np.ndarray) -> None:
        sizes = state.offsets[faces + 1] - state.offsets[faces]
        self._faces, self._count = faces, len(points)
        self._starts = np.cumsum(sizes) - sizes
        self._sizes = sizes
        rows = ranges(state.offsets[faces], state.offsets[faces + 1])
        self._corner = state.corners[rows]
        here, after = points[state.sides.ends[rows]].swapaxes(0, 1)
        way = after - here
        before = np.arange(len(rows)) - 1
        before[self._starts] = self._starts + sizes - 1
        back = -way[before]
        first = np.repeat(here[self._starts], sizes, axis=0)
        self._normals = np.add.reduceat(np.cross(here - first, after - first), self._starts)
        self._angles = angles_between(way, back)
        if len(faces) == len(state.face_origin):
            self._complete = np.ones(len(points), bool)
        else:
            uses = np.bincount(state.corners, minlength=len(points))
            self._complete = np.bincount(self._corner, minlength=len(points)) == uses

    def sharp(self, free: np.ndarray) -> np.ndarray:
        """(n,) whether a vertex is a tip."""
        total = np.bincount(self._corner, self._angles, self._count)
        return (total > 0.0) & (total < np.pi) & self._complete & free

    def folded(self, agree: bool) -> np.ndarray:
        """Ids of the faces whose normals are opposite to those of the other faces at every corner, which must
        `agree`, or need not.
        """
        rows = np.repeat(self._normals, self._sizes, axis=0)
        area = np.linalg.norm(rows, axis=1)
        around = [np.bincount(self._corner, r, self._count)[self._corner] for r in (*rows.T, area)]
        others = np.stack(around[:3], axis=1) - rows
        away = ((others * rows).sum(axis=1) < 0.0) & self._complete[self._corner]
        if agree:
            away &= np.linalg.norm(others, axis=1) >= AGREE * (around[3] - area)
        return self._faces[np.logical_and.reduceat(away, self._starts)]

    def vertices_of(self, faces: np.ndarray) -> np.ndarray:
        chosen = np.isin(self._faces, faces)
        return self._corner[np.repeat(chosen, self._sizes)]


def _around(mesh: MeshPart, vertices: np.ndarray) -> np.ndarray:
    """Ids of the faces at the neighbours of `vertices`, ids or (n,) bool."""
    return mesh.touching(mesh.corners_at(mesh.touching(vertices)))


def in_the_middle(
    state: State, points: np.ndarray, bad: np.ndarray, of_all: bool = False
) -> np.ndarray:
    """The `points`, with `bad` ones at the mean of their neighbours that are not bad, or `of_all`, also
    where all are bad.
    """
    ends = state.sides.ends
    begin, end = np.concatenate([ends, ends[:, ::-1]])[bad[ends.T].ravel()].T
    good = np.bincount(begin, ~bad[end], len(points))
    counts = of_all | ~bad[end] | (good[begin] == 0)
    sums = np.zeros_like(points)
    np.add.at(sums, begin[counts], points[end[counts]])
    number = np.bincount(begin[counts], minlength=len(points))
    return np.where(bad[:, None], sums / np.maximum(number, 1)[:, None], points)


def uncrossed(state: State, fixed: np.ndarray, watchers: tuple[Any, Any]) -> tuple[State, int]:
    """The state without faces that cross others next to them, as far as this can be: corners of such faces
    move to the mean of their neighbours. Where faces still cross after some rounds, as where parts pass
    through each other, all vertices stay, and where the faces around do not agree, as at ears, unless a filled hole is
    there. Vertices `fixed`, (n,) bool, and on borders stay, too. And the number of crossing faces
    that are mended.
    """
    triangles = state.triangles()
    found = _native._crossings(state.points, triangles.astype(np.int32), 0, *watchers)
    if not len(found):
        return state, 0
    mesh = MeshPart.of(state.points, state.corners, state.offsets)
    points, count = state.points.copy(), 0
    for faces in _places(mesh, np.unique(state.face_of[state.triangle_corners[found, 0]])):
        its = mesh.part(faces)
        ids, part = its.vertex_ids, State.of(points[its.vertex_ids], its.corners, its.offsets)
        moved, crossed = _relaxed(part, fixed[ids], watchers)
        if (state.face_origin[faces] < 0).any() or _agree(part, (moved != part.points).any(axis=1)):
            points[ids] = moved
            count += crossed
    return state.replaced(points=points), count


def _places(mesh: MeshPart, crossing: np.ndarray) -> Iterator[np.ndarray]:
    """The faces around `crossing` ones (ids), a list for each place where these are next to each other."""
    near = mesh.part(mesh.touching(mesh.corners_at(crossing)))
    first = np.repeat(near.corners[near.offsets[:-1]], np.diff(near.offsets))
    part = connected_parts(len(near.points), np.stack([first, near.corners], axis=1))
    for place in range(int(part.max()) + 1):
        yield mesh.faces_at(near.vertex_ids[part == place])


def _relaxed(part: State, fixed: np.ndarray, watchers: tuple[Any, Any]) -> tuple[np.ndarray, int]:
    """The points of a `part` of which no faces cross, and the number of those that did; its own points and
    0 if there are none.
    """
    lone = part.sides.uses[part.sides.edge] != 2
    free = ~fixed
    free[part.sides.ends[lone]] = False
    triangles = part.triangles().astype(np.int32)
    points, first, bad = part.points, 0, np.zeros(len(part.points), bool)
    for _ in range(2 * ROUNDS):  # a fold of 44 faces took 11
        found = _native._crossings(points, triangles, 0, *watchers)
        if not len(found):
            return points, first
        first = first or len(found)
        if len(found) > 2 * first:
            break
        bad[triangles[found]] = True
        points = in_the_middle(part, points, bad & free, of_all=True)
    return part.points, 0


def _agree(part: State, moved: np.ndarray) -> bool:
    """Whether the normals of the faces without `moved` vertices, (n,) bool, have a mean of half a length, as
    at a noisy rim of a right angle, and not at ears and fins.
    """
    normals = part.face_vectors[~np.logical_or.reduceat(moved[part.corners], part.offsets[:-1])]
    area = np.linalg.norm(normals, axis=1).sum()
    return bool(np.linalg.norm(normals.sum(axis=0)) >= 0.5 * area)
