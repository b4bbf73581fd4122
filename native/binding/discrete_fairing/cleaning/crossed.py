# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that noise, or a pressed spike, has pushed through faces next to them move back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import _native
from ..arrays import ranges
from ..patches import connected_parts
from .shape import ROUNDS
from .state import State


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
    points, count = state.points.copy(), 0
    for faces in _places(state, np.unique(state.face_of[state.triangle_corners[found, 0]])):
        corners, ends = _gathered(state, faces)
        ids, number = np.unique(corners, return_inverse=True)
        part = State.of(points[ids], number, np.concatenate([[0], ends]))
        moved, crossed = _relaxed(part, fixed[ids], watchers)
        if (state.face_origin[faces] < 0).any() or _agree(part, (moved != part.points).any(axis=1)):
            points[ids] = moved
            count += crossed
    return state.replaced(points=points), count


def _places(state: State, crossing: np.ndarray) -> Iterator[np.ndarray]:
    """The faces around `crossing` ones (ids), a list for each place where these are next to each other."""
    starts, count = state.offsets[:-1], len(state.points)
    at = np.zeros(count, bool)
    at[_gathered(state, crossing)[0]] = True
    near = np.flatnonzero(np.logical_or.reduceat(at[state.corners], starts))
    corners, ends = _gathered(state, near)
    first = np.repeat(state.corners[starts[near]], np.diff(ends, prepend=0))
    part = connected_parts(count, np.stack([first, corners], axis=1))
    inside = np.zeros(count, bool)
    inside[corners] = True
    around = np.flatnonzero(np.logical_or.reduceat(inside[state.corners], starts))
    corners, ends = _gathered(state, around)
    rows = np.repeat(around, np.diff(ends, prepend=0))[inside[corners]]
    pairs = np.unique(np.stack([part[corners[inside[corners]]], rows], axis=1), axis=0)
    yield from np.split(pairs[:, 1], np.flatnonzero(np.diff(pairs[:, 0])) + 1)


def _relaxed(part: State, fixed: np.ndarray, watchers: tuple[Any, Any]) -> tuple[np.ndarray, int]:
    """The points of a `part` of which no faces cross, and the number of those that did; its own points and
    0 if there are none.
    """
    lone = part.sides.uses[part.sides.edge] != 2
    free = ~fixed
    free[part.corners[lone]] = free[part.corners[part.sides.next[lone]]] = False
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
        points = np.where((bad & free)[:, None], _middles(part, points), points)
    return part.points, 0


def _agree(part: State, moved: np.ndarray) -> bool:
    """Whether the normals of the faces without `moved` vertices, (n,) bool, have a mean of half a length, as
    at a noisy rim of a right angle, and not at ears and fins.
    """
    normals = part.face_vectors[~np.logical_or.reduceat(moved[part.corners], part.offsets[:-1])]
    area = np.linalg.norm(normals, axis=1).sum()
    return bool(np.linalg.norm(normals.sum(axis=0)) >= 0.5 * area)


def _middles(part: State, points: np.ndarray) -> np.ndarray:
    """(n, 3) the means of the ends of the sides at each vertex."""
    ends = np.stack([part.corners, part.corners[part.sides.next]], axis=1)
    sums = np.zeros_like(points)
    np.add.at(sums, ends, points[ends[:, ::-1]])
    return sums / np.bincount(ends.ravel(), minlength=len(points))[:, None]


def _gathered(state: State, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The corners of `faces` (ids), one face after another, and the end of each."""
    first, last = state.offsets[faces], state.offsets[faces + 1]
    return state.corners[ranges(first, last)], np.cumsum(last - first)
