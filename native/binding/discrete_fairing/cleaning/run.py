# SPDX-License-Identifier: GPL-3.0-or-later
"""clean(): makes a closed surface of a raw scan."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import face_arrays, fixed_vertices, vertex_array
from ..converters import size, switch
from ..denoising import denoised
from ..watching import Progress, SeveralRuns, check_watchers
from . import topology
from .state import State, all_pairs, diagonals, numbered_parts
from .steps import MENDED, Cleaned, Run


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
    noise: bool = False,
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
        Duplicate faces and parts, faces without area, doubled corners and faces that name vertices which the mesh
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
        half of the angle that they would have in a plane, as at tips higher than 1.6 edges. The tip of a cone
        stays: the surface closes there.
    folds : bool
        So do the corners of faces whose normals are opposite to those of all faces around, which agree, and
        corners of faces that cross others beside them, where that ends the crossing.
    fill : bool
        Holes are filled with fill_holes(), whose arguments are `joint`, `energy`, `density` and `rim`.
        One wider than half of its part, as under a scan that stood on a table, is closed flat where its rim is
        plane, straight across gaps that run into the rim, and by the least area elsewhere.
        Where one cannot be, the faces around it are dropped and it is tried again, up to three times, if
        they are less than half of their part.
    largest : float
        Wider holes stay open: a length, between the two vertices of the rim that are farthest apart. 0: those
        stay open whose flat area is over half of the surface's own, as at the border of a sheet.
    noise : bool
        It is taken off by denoise(), around each vertex as much as the scan there allows.
    fixed : (n,) bool
        Vertices that no step moves. None: none.
    threads, progress, monitor
        As of fair().

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
    switches = {
        **{"mend": mend, "join": join, "fins": fins, "normals": normals, "inner": inner},
        **{"pinched": pinched, "spikes": spikes, "folds": folds, "fill": fill, "noise": noise},
    }
    for name, value in switches.items():
        switch(name, value)
    least, widest = size("islands", islands, 1.0), size("largest", largest)
    points = vertex_array(vertices)
    state = State.of(points, *face_arrays(faces))
    held = fixed_vertices(fixed, len(points))
    watched = SeveralRuns(progress, monitor, threads)
    run = Run(state, watched)
    run.mend(mend)
    if mend:
        run.step("mend", 0.05, topology.without_copies, MENDED["DUPLICATE_FACE"])
    if join:
        run.step("join", 0.1, topology.borders_joined, "border {vertex|vertices} joined")
        if run.count:
            run.mend(mend)
    if fins:
        run.step("fins", 0.15, topology.without_fins, "{face of a fin|faces of fins} dropped")
    if normals:
        run.step("normals", 0.18, run.watched(topology.turned_alike), TURNED)
    if join:
        run.step("join", 0.19, run.watched(topology.edges_cut), CUT)
    if least > 0.0:
        apart = partial(_without_islands, share=least)
        run.step("islands", 0.2, apart, "{island|islands} dropped")
    if inner:
        run.step("inner", 0.25, topology.without_inner, "{face|faces} inside dropped")
    if spikes or folds:
        run.press(held, spikes, folds)
        if mend:
            run.mend(mend)
    if pinched:
        run.step("pinched", 0.3, partial(topology.vertices_split, every=not fill), SPLIT)
    skipped: list[Any] = []
    if fill:
        settings = {"joint": joint, "energy": energy, "density": density, "rim": rim}
        skipped = run.fill(widest, settings)
        if spikes or folds:
            run.press(held, spikes, folds, filled=True)
            if mend:
                run.mend_pressed()
        if pinched:
            run.step("pinched", 0.92, partial(topology.vertices_split, every=True), SPLIT)
    if normals:
        run.step("normals", 0.94, topology.turned_out, TURNED)
    if noise:
        smoothed = partial(_without_noise, fixed=run.held(held))
        run.step("noise", 0.95, smoothed, "{vertex|vertices} smoothed")
    found = run.cleaned(skipped)
    watched.finish()
    return found


CUT = "{edge cut at a vertex on it|edges cut at vertices on them}"
TURNED = "{face|faces} flipped"
SPLIT = "{vertex|vertices} split where parts touched"


def _without_noise(state: State, fixed: np.ndarray) -> tuple[State, int]:
    found = denoised(state.points, state.corners, state.offsets, fixed, None)
    return state.replaced(points=found.vertices), int(np.count_nonzero(found.moves))


def _without_islands(state: State, share: float) -> tuple[State, int]:
    part, count = numbered_parts(state, all_pairs(state))
    size = diagonals(state, part, count)
    small = size < share * size.max()
    return (state.without(small[part]), int(small.sum())) if small.any() else (state, 0)
