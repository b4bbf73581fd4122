# SPDX-License-Identifier: GPL-3.0-or-later
"""What is still wrong with a mesh after clean(): open holes, faces that cross, and what check() finds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import face_arrays, marked, vertex_array
from ..checking import Defect, check
from .state import State


def left_in(vertices: ArrayLike, faces: ArrayLike | Sequence[Sequence[int]]) -> list[Defect]:
    """What clean() would list as left in this mesh, which it has cleaned."""
    state = State.of(vertex_array(vertices), *face_arrays(faces))
    return all_left(state, (), (_native.Monitor(), None))


def all_left(state: State, skipped: Sequence[Exception], watchers: tuple[Any, Any]) -> list[Defect]:
    """Defects, open holes and faces that cross; `skipped`: the errors of holes that were left open."""
    return _defects(state) + _open_holes(state, skipped) + _crossing(state, watchers)


def is_watertight(state: State) -> bool:
    """Whether every edge has two faces, which run along it in opposite directions."""
    sides = state.sides
    a, b = sides.pairs.T
    return bool((sides.uses == 2).all() and (sides.forward[a] != sides.forward[b]).all())


def _defects(state: State) -> list[Defect]:
    """The defects that check() finds. Coincident points count only at borders; elsewhere parts touch."""
    found = check(state.points, (state.corners, state.offsets))
    sides = state.sides
    border = marked(sides.ends[sides.at_border], len(state.points))
    return [
        d
        for d in found
        if d.code != "COINCIDENT_VERTICES" or border[np.ravel(d.elements).astype(int)].any()
    ]


def _open_holes(state: State, skipped: Sequence[Exception]) -> list[Defect]:
    """The border edges as one defect; `skipped`: the errors of holes that were left open."""
    ends = np.sort(state.sides.ends[state.sides.at_border], axis=1)
    if not len(ends):
        return []
    leads = _native.joined(len(state.points), np.ascontiguousarray(ends, np.int64))
    count = len(np.unique(leads[ends[:, 0]]))
    begin = "1 hole is" if count == 1 else f"{count:,} holes are"
    why = f" {skipped[0]}" if skipped else ""
    text = f"{begin} open, of {len(ends):,} edges.{why}"
    return [Defect("OPEN_HOLE", text, list(map(tuple, ends.tolist())), "edge", "warning", False)]


def _crossing(state: State, watchers: tuple[Any, Any]) -> list[Defect]:
    """The faces that cross other faces, as one defect."""
    rows = state.triangle_corners
    found = _native._crossings(state.points, state.triangles().astype(np.int32), 0, *watchers)
    if not len(found):
        return []
    faces = np.unique(state.face_of[rows[found, 0]]).tolist()
    begin = "1 face passes" if len(faces) == 1 else f"{len(faces):,} faces pass"
    text = f"{begin} through others. If the mesh has noise, take it off; else delete them, and fill the hole."
    return [Defect("CROSSING_FACES", text, faces, "face", "warning", False)]
