# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that noise, or a pressed spike, has pushed through faces next to them move back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import _native
from ..arrays import connected_parts
from ..mesh_part import MeshPart
from .shape import ROUNDS, in_the_middle
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
