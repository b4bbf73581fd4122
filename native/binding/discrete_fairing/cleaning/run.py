# SPDX-License-Identifier: GPL-3.0-or-later
"""clean(): makes a closed surface of a raw scan."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import face_arrays, vertex_array
from ..checking import Defect, check
from ..denoising import denoised
from ..errors import about, fairing_error
from ..options import switch, whole
from ..watching import Progress, SeveralRuns, check_watchers
from . import holes, left, shape, topology
from .state import State, all_pairs, diagonals, numbered_parts


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


def clean(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    mend: bool = True,
    join: bool = True,
    islands: float = 0.1,
    fins: bool = True,
    normals: bool = True,
    inner: bool = True,
    pinched: bool = True,
    spikes: bool = True,
    folds: bool = True,
    fill: bool = True,
    largest: float = 0.0,
    joint: str = "curvature",
    energy: str = "thin_plate",
    density: float = 1.0,
    rim: str = "exact",
    noise: int | str = 0,
    fixed: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
) -> Cleaned:
    """Make a closed surface of a scan: junk goes, what is wrong is mended, holes are filled.

    The steps come in this order, and each can be turned off. What none of them concerns stays as it was,
    to the bit.

    Parameters
    ----------
    vertices : (n, 3) float
        In any unit of length.
    faces : (m, 3) or (m, 4) int, a list of polygons, or the pair (corners, offsets) of flat arrays
        As they come.
    mend : bool
        Duplicate faces, faces without area, doubled corners and faces that name vertices which the mesh
        does not have, as fair() mends them; vertices without a face go.
    join : bool
        Border edges that lie on one another, end on end, become one: files such as STL know no others. Those
        with vertices of other faces on them are cut there.
    islands : float
        Parts whose box has a diagonal shorter than this share of the largest part's are dropped. 0: none.
    fins : bool
        Where more than two faces meet at an edge, the smallest part there that ends in a border is
        dropped, until two are left.
    normals : bool
        Faces that look another way than their neighbours are turned over, and at the end closed parts
        that look inwards, but for hollows.
    inner : bool
        Parts inside of others are dropped: their winding number is over one half. Hollows stay, closed
        parts that look into themselves.
    pinched : bool
        Where parts touch in a vertex or an edge, each gets its own.
    spikes : bool
        A vertex goes to the middle of its neighbours where the faces around it have together less than
        half of the angle that they would have in a plane: tips higher than 1.6 edges.
    folds : bool
        So do the corners of faces that look away from all faces around.
    fill : bool
        Holes are filled with fill_holes(), whose arguments are `joint`, `energy`, `density` and `rim`.
        One wider than half of its part, as under a scan that stood on a table, is closed by the least area.
        Where one cannot be, the faces around it are dropped and it is tried again, up to three times.
    largest : float
        Wider holes stay open: a length, between the two vertices of the rim that are farthest apart. 0: those
        stay open whose flat area is over half of the surface's own, as at the border of a sheet.
    noise : int or "auto"
        "auto": it is taken off by denoise(), around each vertex as much as the scan there allows. A number:
        by so many of its passes, the fast choice, up to 1000; they round sharp edges that are not
        `fixed`. 0: none is.
    fixed : (n,) bool
        Vertices that no step moves. None: none.
    threads : int
        0: all cores. The result is the same, to the last bit, for any number.
    progress : callable(fraction, phase)
        Called from this thread; returning False cancels.
    monitor : Monitor
        For watching and cancelling from another thread.

    Returns
    -------
    Cleaned

    Raises
    ------
    FairingError
        BAD_OPTION, BAD_SHAPE; NON_FINITE and NO_FACES where no program could tell what the surface is;
        CANCELLED after a cancel.
    """
    check_watchers(progress, monitor)
    for name, value in (
        ("mend", mend),
        ("join", join),
        ("fins", fins),
        ("normals", normals),
        ("inner", inner),
        ("pinched", pinched),
        ("spikes", spikes),
        ("folds", folds),
        ("fill", fill),
    ):
        switch(name, value)
    _require_number("islands", islands, 1.0)
    _require_number("largest", largest, np.inf)
    passes = _passes(noise)
    points = vertex_array(vertices)
    state = State.of(points, *face_arrays(faces))
    held = _fixed(fixed, len(points))
    watched = SeveralRuns(progress, monitor, threads)
    run = _Run(state, watched)
    run.mend(mend)
    if join:
        run.step(
            "join", 0.1, topology.borders_joined, "border vertex joined", "border vertices joined"
        )
        if run.count:
            run.mend(mend)
    if normals:
        run.step("normals", 0.15, run.watched(topology.turned_alike), *TURNED)
    if fins:
        run.step("fins", 0.18, topology.without_fins, *_dropped("of a fin", "of fins"))
    if join:
        run.step("join", 0.19, run.watched(topology.edges_cut), *CUT)
    if islands > 0.0:
        apart = partial(_without_islands, share=float(islands))
        run.step("islands", 0.2, apart, "island dropped", "islands dropped")
    if inner:
        run.step("inner", 0.25, topology.without_inner, *_dropped("inside", "inside"))
    if spikes or folds:
        run.press(held, spikes, folds)
        if mend:
            run.mend(mend)
    if pinched:
        run.step("pinched", 0.3, partial(topology.vertices_split, every=not fill), *SPLIT)
    skipped: list[Any] = []
    if fill:
        settings = {"joint": joint, "energy": energy, "density": density, "rim": rim}
        skipped = run.fill(float(largest), settings)
        if spikes or folds:
            run.press(held, spikes, folds, filled=True)
        if pinched:
            run.step("pinched", 0.92, partial(topology.vertices_split, every=True), *SPLIT)
    if normals:
        run.step("normals", 0.94, topology.turned_out, *TURNED)
    if passes is not None:
        smoothed = partial(_without_noise, fixed=run.held(held), passes=passes)
        run.step("noise", 0.95, smoothed, "vertex smoothed", "vertices smoothed")
    found = run.cleaned(skipped)
    watched.finish()
    return found


CUT = "edge cut at a vertex on it", "edges cut at vertices on them"
TURNED = "face flipped", "faces flipped"
SPLIT = (
    "vertex split where parts touched",
    "vertices split where parts touched",
)
_CODES = {
    "BAD_SHAPE": (
        "face of fewer than three corners dropped",
        "faces of fewer than three corners dropped",
    ),
    "INDEX_OUT_OF_RANGE": (
        "face with missing vertices dropped",
        "faces with missing vertices dropped",
    ),
    "NON_FINITE": (
        "vertex without a finite position dropped",
        "vertices without a finite position dropped",
    ),
    "REPEATED_VERTEX": ("doubled corner dropped", "faces with doubled corners mended"),
    "COINCIDENT_VERTICES": ("vertex of a face merged", "vertices of faces merged"),
    "DUPLICATE_FACE": ("duplicate face dropped", "duplicate faces dropped"),
    "DEGENERATE_FACE": ("face without area dissolved", "faces without area dissolved"),
}


def _dropped(one: str, several: str) -> tuple[str, str]:
    return f"face {one} dropped", f"faces {several} dropped"


def _passes(noise: int | str) -> int | None:
    """The argument `passes` of denoise(); None: no denoising."""
    if isinstance(noise, str):
        if noise != "auto":
            raise fairing_error(
                "BAD_OPTION", f'noise is {noise!r}; it must be "auto" or a number of passes.'
            )
        return 0
    passes = whole("noise", noise)
    if passes > 1000:
        raise fairing_error("BAD_OPTION", f"noise is {passes}; it must be from 0 to 1000.")
    return passes or None


def _require_number(name: str, value: Any, most: float) -> None:
    if isinstance(value, bool) or not (isinstance(value, int | float) and 0.0 <= value <= most):
        limit = f"from 0 to {most:g}" if np.isfinite(most) else "0 or more"
        raise fairing_error("BAD_OPTION", f"{name} is {value!r}; it must be {limit}.")


def _fixed(fixed: ArrayLike | None, count: int) -> np.ndarray:
    if fixed is None:
        return np.zeros(count, bool)
    array = np.asarray(fixed)
    if array.shape != (count,) or array.dtype != bool:
        raise fairing_error(
            "BAD_SHAPE", f"fixed has shape {array.shape}; it must be ({count},), True or False."
        )
    return array


def _without_noise(state: State, fixed: np.ndarray, passes: int) -> tuple[State, int]:
    found = denoised(state.points, state.corners, state.offsets, fixed, None, passes)
    return state.replaced(points=found.vertices), int(np.count_nonzero(found.moves))


def _without_islands(state: State, share: float) -> tuple[State, int]:
    part, count = numbered_parts(state, all_pairs(state))
    size = diagonals(state, part, count)
    small = size < share * size.max()
    return (state.without(small[part]), int(small.sum())) if small.any() else (state, 0)


class _Run:
    """The current state of the mesh, and the reports of the steps so far."""

    def __init__(self, state: State, watched: SeveralRuns) -> None:
        self.state, self._watched = state, watched
        self.done: list[Act] = []
        self.count = 0  # elements that the last step concerned
        self._at = 0.0
        self._loose_told = False

    @property
    def watchers(self) -> tuple[Any, Any]:
        run = self._watched.run(self._at, self._at)
        return run["monitor"], run["progress"]

    def watched(
        self, call: Callable[..., tuple[State, int]]
    ) -> Callable[[State], tuple[State, int]]:
        """A step that is called with the watchers for its share of the progress."""
        return lambda state: call(state, self.watchers)

    def note(self, step: str, count: int, one: str, several: str) -> None:
        self.count = count
        if count:
            text = f"1 {one}" if count == 1 else f"{count:,} {several}"
            self.done.append(Act(step, count, text))

    def step(
        self,
        name: str,
        fraction: float,
        call: Callable[[State], tuple[State, int]],
        one: str,
        several: str,
    ) -> None:
        self._at = fraction
        if not len(self.state.face_origin):
            return
        self._watched.run(fraction, fraction)["progress"](1.0, "check")
        self.state, count = call(self.state)
        self.note(name, count, one, several)

    def mend(self, wanted: bool) -> None:
        """Mends if `wanted`; meshes that no step could read are refused in any case."""
        mended, acts = topology.mended(self.state, self.watchers)
        if not wanted and acts:
            first = check(self.state.points, (self.state.corners, self.state.offsets))[0]
            raise fairing_error(first.code, first.message)
        if wanted and not self._loose_told:
            loose = len(self.state.points) - len(np.unique(self.state.corners))
            self.note(
                "mend", loose, "vertex without a face dropped", "vertices without a face dropped"
            )
        self._loose_told = True
        self.state = mended
        for code, count in acts.items():
            self.note("mend", count, *_CODES[code])

    def held(self, fixed: np.ndarray) -> np.ndarray:
        """(n,) bool: present vertices that come from `fixed` vertices of the input."""
        origin = self.state.vertex_origin
        return fixed[origin] & (origin >= 0)

    def press(self, fixed: np.ndarray, spikes: bool, folds: bool, filled: bool = False) -> None:
        held = self.held(fixed)
        self.state, tips, folded = shape.flattened(self.state, held, spikes, folds, filled)
        self.note("spikes", tips, "spike flattened", "spikes flattened")
        self.note("folds", folded, "folded face flattened", "folded faces flattened")

    def fill(self, largest: float, settings: dict[str, Any]) -> list[Any]:
        before = len(self.state.face_origin)
        self.state, count, faces, skipped = holes.closed(
            self.state, largest, settings, self._watched
        )
        one = f"hole filled with {faces:,} faces"
        self.note("fill", count, one, one.replace("hole", "holes"))
        cut = before + faces - len(self.state.face_origin)
        self.note("fill", cut, *_dropped("at a bad rim", "at bad rims"))
        return skipped

    def cleaned(self, skipped: list[Any]) -> Cleaned:
        state, number = self.state.compact()
        self.state = state
        found = left.defects(state)
        found += left.open_holes(
            state, [about(h.error, number[h.error.elements].tolist()) for h in skipped]
        )
        found += left.crossing(state, self.watchers)
        watertight = left.is_watertight(state)
        rows = np.zeros(len(state.face_origin), np.int64)
        volume = float(topology.volumes(state, rows, 1)[0]) if watertight else float("nan")
        sizes = np.diff(state.offsets)
        faces: Any = state.corners, state.offsets
        if (sizes == 3).all():
            faces = state.corners.reshape(-1, 3)
        origins = state.vertex_origin, state.face_origin, state.corner_origin
        return Cleaned(state.points, faces, *origins, self.done, watertight, volume, found)
