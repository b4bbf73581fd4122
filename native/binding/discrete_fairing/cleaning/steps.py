# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of clean(): the mesh that they have come to, and their reports."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..checking import Defect, check
from ..errors import about, fairing_error
from ..watching import SeveralRuns
from . import holes, left, shape, topology
from .state import State


@dataclass(frozen=True, slots=True)
class Act:
    """The report of one step of clean().

    step: str
        The name of the step, which is the argument of clean() that turns it off.
    count: int
        The number of elements concerned.
    text: str
        The result in words, such as "3 spikes flattened".
    """

    step: str
    count: int
    text: str


@dataclass(frozen=True, slots=True)
class Cleaned:
    """A mesh that clean() has cleaned.

    vertices: (N, 3) float64
        Those that were there first, in their order but for copies where parts were cut; new ones last.
    faces: (M, 3) int64, or the pair (corners, offsets) where not all are triangles
        Those that were there first, in their order; new ones last.
    vertex_origin, face_origin: (N,), (M,) int64
        For each element of the input the id there that it comes from; -1: it is new.
    corner_origin: (C,) int64
        The same for the corners of the faces, one after another.
    done: list of Act
        What was done, in order; steps that found nothing are left out.
    watertight: bool
        Whether every edge has two faces that run it in opposite directions.
    volume: float
        What the surface encloses, in the cube of the unit of length; NaN where it is not watertight.
    left: list of Defect
        What is still wrong: what check() finds, OPEN_HOLE with the edges of holes that are open, and
        CROSSING_FACES with faces that pass through others.
    """

    vertices: np.ndarray
    faces: np.ndarray | tuple[np.ndarray, np.ndarray]
    vertex_origin: np.ndarray
    face_origin: np.ndarray
    corner_origin: np.ndarray
    done: list[Act]
    watertight: bool
    volume: float
    left: list[Defect]


# by code, of one element or several
MENDED = {
    "BAD_SHAPE": "{face|faces} of fewer than three corners dropped",
    "INDEX_OUT_OF_RANGE": "{face|faces} with missing vertices dropped",
    "NON_FINITE": "{vertex|vertices} without a finite position dropped",
    "REPEATED_VERTEX": "{doubled corner dropped|faces with doubled corners mended}",
    "COINCIDENT_VERTICES": "{vertex of a face|vertices of faces} merged",
    "DUPLICATE_FACE": "duplicate {face|faces} dropped",
    "DEGENERATE_FACE": "{face|faces} without area dissolved",
}


class Run:
    """The current state of the mesh, and the reports of the steps so far."""

    def __init__(self, state: State, watched: SeveralRuns) -> None:
        self.state, self._watched = state, watched
        self.done: list[Act] = []
        self.count = 0  # elements that the last step concerned
        self._at = 0.0
        self._loose_told = False

    @property
    def watchers(self) -> tuple[Any, Any]:
        return self._watched.watchers(self._at)

    def watched(
        self, call: Callable[..., tuple[State, int]]
    ) -> Callable[[State], tuple[State, int]]:
        """A step that is called with the watchers for its share of the progress."""
        return lambda state: call(state, self.watchers)

    def note(self, step: str, count: int, text: str) -> None:
        """Reports a step; of `{one|several}` in the text the part that the count wants."""
        self.count = count
        if count:
            text = re.sub(r"{(.*?)\|(.*?)}", r"\1" if count == 1 else r"\2", text)
            self.done.append(Act(step, count, f"{count:,} {text}"))

    def step(
        self, name: str, fraction: float, call: Callable[[State], tuple[State, int]], text: str
    ) -> None:
        self._at = fraction
        if not len(self.state.face_origin):
            return
        self._watched.run(fraction, fraction)["progress"](1.0, "check")
        self.state, count = call(self.state)
        self.note(name, count, text)

    def mend(self, wanted: bool) -> None:
        """Mends if `wanted`; meshes that no step could read are refused in any case."""
        mended, acts = topology.mended(self.state, self.watchers)
        if not wanted and acts:
            first = check(self.state.points, (self.state.corners, self.state.offsets))[0]
            raise fairing_error(first.code, first.message)
        if wanted and not self._loose_told:
            loose = len(self.state.points) - len(np.unique(self.state.corners))
            self.note("mend", loose, "{vertex|vertices} without a face dropped")
        self._loose_told = True
        self._note_mended(mended, acts)

    def mend_pressed(self) -> None:
        """Mends faces that press() has left without area, and joins the slits that stay where two vertices lie
        on an edge between them; not if that opens a border.
        """
        mended, acts = topology.mended(self.state, self.watchers)
        mended, _ = topology.borders_joined(mended)
        if mended.sides.at_border.sum() <= self.state.sides.at_border.sum():
            self._note_mended(mended, acts)

    def _note_mended(self, mended: State, acts: dict[str, int]) -> None:
        self.state = mended
        for code, count in acts.items():
            self.note("mend", count, MENDED[code])

    def held(self, fixed: np.ndarray) -> np.ndarray:
        """(n,) bool: present vertices that come from `fixed` vertices of the input."""
        origin = self.state.vertex_origin
        return fixed[origin] & (origin >= 0)

    def press(self, fixed: np.ndarray, spikes: bool, folds: bool, filled: bool = False) -> None:
        held = self.held(fixed)
        self.state, tips, folded = shape.flattened(self.state, held, spikes, folds, filled)
        self.note("spikes", tips, "{spike|spikes} flattened")
        self.note("folds", folded, "folded {face|faces} flattened")
        if folds:
            self.state, through = shape.uncrossed(self.state, held, self.watchers)
            self.note("folds", through, "crossing {face|faces} moved back")

    def fill(self, largest: float, settings: dict[str, Any]) -> list[Any]:
        before = len(self.state.face_origin)
        self.state, count, faces, skipped = holes.closed(
            self.state, largest, settings, self._watched
        )
        made = f"{faces:,} face" + "s" * (faces != 1)
        self.note("fill", count, f"{{hole|holes}} filled with {made}")
        cut = before + faces - len(self.state.face_origin)
        self.note("fill", cut, "{face at a bad rim|faces at bad rims} dropped")
        return skipped

    def cleaned(self, skipped: list[Any]) -> Cleaned:
        state, number = self.state.compact()
        self.state = state
        why = [about(h.error, number[h.error.elements].tolist()) for h in skipped]
        found = left.all_left(state, why, self.watchers)
        watertight = left.is_watertight(state)
        rows = np.zeros(len(state.face_origin), np.int64)
        volume = float(topology.volumes(state, rows, 1)[0]) if watertight else float("nan")
        sizes = np.diff(state.offsets)
        faces: Any = state.corners, state.offsets
        if (sizes == 3).all():
            faces = state.corners.reshape(-1, 3)
        origins = state.vertex_origin, state.face_origin, state.corner_origin
        return Cleaned(state.points, faces, *origins, self.done, watertight, volume, found)
