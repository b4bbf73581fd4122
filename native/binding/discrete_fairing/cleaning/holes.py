# SPDX-License-Identifier: GPL-3.0-or-later
"""Which holes are closed, and what is cut back around those that cannot be."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _native
from ..arrays import face_arrays
from ..filling import fill_holes
from ..watching import SeveralRuns
from .state import State, diagonals, numbered_parts, of_parts
from .topology import vertices_split

CUTS = 3  # times that the faces around a bad rim are taken away, a ring at a time


def length_of(points: np.ndarray) -> float:
    """Of a rim: the diagonal of the box around it."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def wanted_holes(state: State, holes: list[Any], largest: float) -> tuple[list[Any], list[Any]]:
    """Of holes, each a rim and those of islands in it, the ones to be closed: those across which the
    surface goes on, and those wider than half of the part that they are in, where nobody knows how.
    `largest`: the longest diagonal of a hole's box; 0: what is flat within the rim has less than half of the area of the part: the border of a sheet has all
    of it, that of half a ball just half.
    """
    part, count = numbered_parts(state, state.sides.pairs)
    of_vertex = np.zeros(len(state.points), np.int64)
    of_vertex[state.corners] = part[state.face_of]
    sizes = diagonals(state, part, count)
    areas = of_parts(part, np.linalg.norm(state.face_vectors(), axis=1), count)
    narrow: list[Any] = []
    wide: list[Any] = []
    for hole in holes:
        points, name = state.points[hole[0]], of_vertex[hole[0][0]]
        length = length_of(points)
        if length <= largest if largest > 0.0 else _flat_area(points) < 0.5 * areas[name]:
            (narrow if length <= 0.5 * sizes[name] else wide).append(hole)
    return narrow, wide


def _flat_area(points: np.ndarray) -> float:
    """Twice the area that a closed polygon has, seen from where it is largest."""
    centred = points - points.mean(axis=0)
    return float(np.linalg.norm(np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)))


def closed(
    state: State, largest: float, settings: dict[str, Any], watched: SeveralRuns
) -> tuple[State, int, int, list[Any]]:
    """With its holes filled; how many holes and new faces, and what could not be filled (SkippedHole).
    Where that is so, the faces around are taken away, and what is left is tried again.
    """
    holes = faces = 0
    skipped: list[Any] = []
    for turn in range(CUTS + 1):
        state, _ = vertices_split(state, every=False)
        run = watched.run(0.3, 0.9)
        watchers = run["monitor"], run["progress"]
        filler = _native.Filler(state.points, state.corners, state.offsets)
        loops, unclear = filler.find(*watchers)
        narrow, wide = wanted_holes(state, filler.with_islands(loops, *watchers), largest)
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
            state = state.extended(found.vertices, *face_arrays(found.faces))
            holes, faces = holes + len(found.holes), faces + len(found.new_faces)
            skipped += found.skipped
        bad = np.zeros(len(state.points), bool)
        for why in unclear:
            bad[np.ravel(why["elements"]).astype(np.int64)] = True
        for hole in skipped:
            bad[np.ravel(hole.elements).astype(np.int64)] = True
        if not bad.any() or turn == CUTS:
            break
        state = _cut_back(state, bad)
    return state, holes, faces, skipped


def _cut_back(state: State, vertices: np.ndarray) -> State:
    """Without the faces at these `vertices`, (n,) bool, and what then hangs by nothing."""
    gone = np.logical_or.reduceat(vertices[state.corners], state.offsets[:-1])
    state = state.without(gone)
    uses = state.sides.uses[state.sides.edge]
    alone = np.logical_and.reduceat(uses == 1, state.offsets[:-1])
    return state.without(alone) if alone.any() else state
