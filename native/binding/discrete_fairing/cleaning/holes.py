# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses and fills holes, and removes faces around those that cannot be filled."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import face_arrays, vertex_array
from ..converters import size
from ..holes.filling import asked_holes, fill_holes, with_islands
from ..watching import SeveralRuns
from .flat_rims import stood_on
from .state import State, diagonals, numbered_parts
from .topology import cut, vertices_split

BLOCK = 64  # rows of distances at a time: 25 MB for the longest rim
CUTS = 3  # rings of faces that may be removed around a bad rim, one ring a trial


def hole_width(rim: ArrayLike) -> float:
    """The diameter of a hole: the largest distance between two points (k, 3) of its `rim`. `largest` of
    clean() and holes_to_fill() limits this length.
    """
    points = np.asarray(rim, float).reshape(-1, 3)
    if not len(points):
        return 0.0
    points = points - (points.min(axis=0) + points.max(axis=0)) / 2
    radii = np.linalg.norm(points, axis=1)
    width = float(np.linalg.norm(points - points[np.argmax(radii)], axis=1).max())
    # pairs with other points are nearer to each other
    ends = points[radii >= width - radii.max()]
    for first in range(0, len(ends), BLOCK):
        away = ends[first : first + BLOCK, None] - ends
        width = max(width, float(np.linalg.norm(away, axis=2).max()))
    return width


def holes_to_fill(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    holes: Sequence[Any] | None = None,
    largest: float = 0.0,
) -> list[list[np.ndarray]]:
    """The holes that clean() fills, for fill_holes(): those whose hole_width() is at most `largest`. With
    `largest` 0: holes whose flat area within the rim is less than half of the area of their part, so that
    borders of sheets stay open. `holes` None: all holes of with_islands().
    Raises FairingError BAD_OPTION for a `largest` below 0, and the errors of with_islands().
    """
    most, points = size("largest", largest), vertex_array(vertices)
    asked = asked_holes(with_islands(vertices, faces) if holes is None else holes)
    for hole in asked:
        if len(hole) > 1:
            hole.sort(key=lambda loop: -hole_width(points[loop]))  # the rim becomes the first loop
    narrow, wide = wanted_holes(State.of(points, *face_arrays(faces)), asked, most)
    chosen = {id(hole) for hole in narrow + wide}
    return [list(map(np.array, hole)) for hole in asked if id(hole) in chosen]


def wanted_holes(state: State, holes: list[Any], largest: float) -> tuple[list[Any], list[Any]]:
    """The holes to close, and those left open because they are wider than half of their part, so that the
    surface across them is unknown. A hole is a rim and the rims of its islands. `largest`: the largest
    width to close; 0: holes whose flat area within the rim is less than half of the area of their part
    (the border of a sheet has all of it, the border of half a ball just half).
    """
    if largest > 0.0:
        holes = [hole for hole in holes if hole_width(state.points[hole[0]]) <= largest]
    if not holes:
        return [], []
    part, count = numbered_parts(state, state.sides.pairs)
    of_vertex = np.zeros(len(state.points), np.int64)
    of_vertex[state.corners] = part[state.face_of]
    sizes = diagonals(state, part, count)
    if largest == 0.0:
        areas = np.bincount(part, np.linalg.norm(state.face_vectors, axis=1), count)
    narrow: list[Any] = []
    wide: list[Any] = []
    for hole in holes:
        points, name = state.points[hole[0]], of_vertex[hole[0][0]]
        if largest > 0.0 or _flat_area(points) < 0.5 * areas[name]:
            diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
            (narrow if diagonal <= 0.5 * sizes[name] else wide).append(hole)
    return narrow, wide


def _flat_area(points: np.ndarray) -> float:
    """Twice the area of a closed polygon, projected along the direction in which it is largest."""
    centred = points - points.mean(axis=0)
    return float(np.linalg.norm(np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)))


def closed(
    state: State, largest: float, settings: dict[str, Any], watched: SeveralRuns
) -> tuple[State, int, int, list[Any]]:
    """The state with its holes filled, the numbers of holes and of new faces, and the skipped holes
    (SkippedHole). Around a skipped hole the faces are removed and the larger hole is tried again.
    """
    holes = faces = 0
    skipped: list[Any] = []
    for turn in range(CUTS + 1):
        state, _ = vertices_split(state, every=False)
        watchers = watched.watchers(0.3)
        loops, unclear = _found(state, watchers)
        narrow, wide = wanted_holes(state, loops, largest)
        before = len(state.face_origin)
        state, flat = stood_on(state, wide, settings | watched.run(0.3, 0.3))
        if flat:  # gaps at their rims are holes now
            holes, faces = holes + flat, faces + len(state.face_origin) - before
            loops, unclear = _found(state, watchers)
            narrow, wide = wanted_holes(state, loops, largest)
        skipped = []
        for wanted, how in ((narrow, settings), (wide, settings | {"joint": "position"})):
            if not wanted:
                continue
            found = fill_holes(
                state.points,
                (state.corners, state.offsets),
                holes=wanted,
                **how,
                **watched.run(0.3, 0.9),
            )
            state = cut(state.extended(found.vertices, *found.uncut), found.cuts)
            holes, faces = holes + len(found.holes) + len(found.cuts), faces + len(found.new_faces)
            skipped += found.skipped
        bad = np.zeros(len(state.points), bool)
        for why in unclear:
            bad[np.ravel(why["elements"]).astype(np.int64)] = True
        for hole in skipped:
            bad[np.ravel(hole.elements).astype(np.int64)] = True
            if hole.loops:  # an error names one place, and a ragged rim has many
                bad[_coincident(state.points, np.concatenate(hole.loops))] = True
        gone = _cut_back(state, bad)
        if not gone.any() or turn == CUTS:
            break
        state = state.without(gone)
    return state, holes, faces, skipped


def _found(state: State, watchers: tuple[Any, Any]) -> tuple[list[Any], list[Any]]:
    """All holes, with their islands, and the reasons why other border edges surround none."""
    filler = _native.Filler(state.points, state.corners, state.offsets)
    loops, unclear = filler.find(*watchers)
    return filler.with_islands(loops, *watchers), unclear


def _coincident(points: np.ndarray, ids: np.ndarray) -> np.ndarray:
    """Those of the vertices `ids` that lie on others of them."""
    _, place, uses = np.unique(points[ids], axis=0, return_inverse=True, return_counts=True)
    return ids[uses[place.ravel()] > 1]


def _cut_back(state: State, vertices: np.ndarray) -> np.ndarray:
    """(m,) bool: the faces at these `vertices`, (n,) bool, and parts that only they attach. Parts of which
    most faces would go stay.
    """
    gone = np.logical_or.reduceat(vertices[state.corners], state.offsets[:-1])
    left = state.without(gone)
    uses = left.sides.uses[left.sides.edge]
    if len(left.face_origin):
        gone[~gone] = np.logical_and.reduceat(uses == 1, left.offsets[:-1])
    part, count = numbered_parts(state, state.sides.pairs)
    of_part = np.bincount(part, gone, count)
    return gone & (2 * of_part < np.bincount(part, minlength=count))[part]
