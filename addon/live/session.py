# SPDX-License-Identifier: GPL-3.0-or-later
"""One live surface: its source, solver and mesh. Called by `handlers` on the main thread."""

from collections.abc import Collection
from time import perf_counter
from typing import Any

import numpy as np

from .. import errors, memory
from ..blender import Context, Object, current_context, scene_of
from ..errors import JobError
from ..inspection import display, overlay
from ..memory import source_of
from ..mesh.layers import read_data
from ..mesh.object import Reference, session_key
from ..mesh.own import OwnData, carried_names, read_own, write_own
from ..mesh.write import has_faces_of, write_positions, write_surface
from ..queue import progress_text
from ..settings import is_evaluated
from ..surfaces import neighbours, place
from ..transfer.attributes import AttributeTransfer
from ..transfer.seams import sharp_pairs
from .full_level import FullLevel, Schedule
from .live_solver import LiveSolver, Update
from .registry import why_gone

SURFACE_EDITED = "The surface itself is being edited: Live waits"


class Session:
    """Follows the source of a faired object; `trouble`: why it cannot now, a sentence or empty."""

    def __init__(self, target: Object) -> None:
        self._target = Reference(target)
        self.key = self._target.key
        self.ending = False  # switched off, but the full level is still to come
        self.trouble = ""
        self.level = 0  # level of the surface shown last
        self.triangles = 0
        self.seconds = 0.0  # of the last update
        self.updates = 0
        self._stale = True  # whether the mesh may differ from the one written
        # whether the timer must check, because Blender's update did not show a change
        self._unseen = False
        self._schedule = Schedule()  # of the full level
        self._own: OwnData | None = None  # the surface's own data, for its full level
        self.made: LiveSolver | None = None  # for the present settings

    def objects(self) -> tuple[Object | None, Object | None]:
        """(source, target), None for deleted ones."""
        target = self._target.find()
        return (source_of(target) if target is not None else None), target

    def _present(self) -> tuple[Object, Object]:
        """(source, target), which must exist: `why_gone` is called before."""
        source, target = self.objects()
        assert source is not None and target is not None
        return source, target

    def why_gone(self) -> str:
        """Why the surface can no longer be followed, a sentence; empty if it can."""
        return why_gone(*self.objects())

    def needs_look(self, reshaped: Collection[int] = (), moved: Collection[int] = ()) -> bool:
        """Whether the surface may be out of date; `reshaped`: keys of the data-blocks with changed
        geometry, `moved`: with a changed transform. The timer reads scans and neighbours again, once
        nothing is dragged, since they may be large.
        """
        source, target = self._present()
        its = {session_key(source), session_key(source.data)}
        if self.made is None:
            return True
        again = self.made.dependencies.are_awaited(source, target, moved)
        if self._stale or self._unseen or again or not its.isdisjoint(reshaped):
            return True
        return not self.made.fits(source, target)

    def mark_stale(self) -> None:
        """Notes that anything may have changed, as by undo. May be called on any thread."""
        self._stale = True
        self._write_anew()

    def _write_anew(self) -> None:
        """The next surface replaces the mesh, whatever its faces are."""
        if self.made is not None:
            self.made.mesh = None

    def stand(self) -> None:
        """Gives the surface the transform of its source."""
        place.follow(None, self._present()[1])

    def follow(self, depsgraph: Update = None) -> bool:
        """Updates the surface for changes of source and settings, at the live level.

        A hidden source cannot be read within an update; the timer does it later. True if anything has
        changed.
        """
        source, target = self._present()
        self._unseen = False
        if depsgraph is not None and depsgraph.mode == "VIEWPORT":
            seen = source.visible_get(view_layer=depsgraph.view_layer)
            self._unseen = is_evaluated(target.discrete_fairing) and not seen
        if self._unseen:
            return False
        if target.mode == "EDIT":
            self.trouble, self._stale = SURFACE_EDITED, True
            return False
        try:
            with errors.explained(source.name):
                return self._follow(source, target, depsgraph)
        except JobError as error:
            self.wait(str(error))
        return True

    def _follow(self, source: Object, target: Object, depsgraph: Update) -> bool:
        began = perf_counter()
        made = self.made
        if made is None or not made.fits(source, target):
            made = self.made = LiveSolver(source, target)
            made.dependencies.read(source, target, made.settings)
        elif made.dependencies.due and depsgraph is None:
            made.dependencies.read(source, target, made.settings)
        arrays = made.read(source, depsgraph)
        is_new = made.prepare(source, arrays, depsgraph)
        if not (is_new or self._stale or self.trouble) and np.array_equal(
            arrays.positions, made.arrays.positions
        ):
            return False
        self.cancel_full()
        made.arrays = arrays
        result = made.solve(source, arrays, depsgraph)
        self._write(made, source, target, result, depsgraph)
        self.seconds, self.trouble = perf_counter() - began, ""
        if result.report["warm"] or not is_new:
            made.pace.note(self.level, made.arguments["energy"], self.seconds)
        self.updates += 1
        self._schedule.plan()
        return True

    def _write(
        self, made: LiveSolver, source: Object, target: Object, result: Any, depsgraph: Update
    ) -> None:
        if made.mesh != session_key(target.data) or not has_faces_of(target.data, result):
            with made.mesh_now(source, depsgraph) as mesh:
                data = read_data(source, mesh, is_evaluated(made.settings))
            if self._own is None:
                carried = memory.recall(target, "carried") or {}
                self._own = read_own(target, carried_names(data, data.shape_keys), carried)
            pairs = sharp_pairs(result, made.arrays, made.settings, made.level)
            transfer = AttributeTransfer(result, made.arrays, made.level)
            its = result, pairs, data, transfer, made.settings
            write_surface(target, *its, operators=False)
            if self._own is not None:
                write_own(target, self._own, in_handler=True)
            made.mesh = session_key(target.data)
            if not target.discrete_fairing.unfinished:
                target.discrete_fairing.unfinished = True
        else:
            write_positions(target.data, result.vertices)
        neighbours.update_normals(current_context(), target, depsgraph)
        overlay.moved(target)
        display.remeasure(target, scene_of(target).discrete_fairing_inspection)
        self.level = made.level
        self.triangles = len(result.faces[0]) + 2 * len(result.faces[1])
        self._stale = False

    def wait(self, sentence: str) -> None:
        """Keeps the last good surface until the source is valid again; `sentence` describes its fault."""
        self.cancel_full()
        self.trouble = sentence
        self._stale = False
        self._schedule.drop()

    # --- the full level

    @property
    def is_waiting(self) -> bool:
        """Whether the full level is still to come."""
        return self._schedule.is_planned or self._schedule.run is not None

    def cancel_full(self, wait: bool = False) -> None:
        """Cancels the full level after an edit, and plans it again."""
        self._schedule.cancel(wait)

    def advance(self, context: Context) -> None:
        """Starts the full level when edits have paused, and writes it when it is complete."""
        run = self._schedule.run
        if run is not None and run.finished:
            self._finish(context)
        elif self._schedule.is_due(context, at_once=self.ending):
            full = self._begin(context)
            if full is not None:
                full.start()

    def follow_unseen(self) -> None:
        """Follows changes unseen by Blender's update, scans and neighbours; not within one."""
        if self._unseen or (self.made is not None and self.made.dependencies.due):
            self.follow()

    def complete(self, context: Context) -> None:
        """Computes the full level now, if it is due: for scripts, and without a window."""
        self.follow_unseen()
        full = self._begin(context) if self._schedule.is_planned else None
        if full is None:
            return
        try:
            full.job.compute()
        except JobError as error:
            self._schedule.run = None
            self.wait(str(error))
            return
        self._finish(context)

    def _begin(self, context: Context) -> FullLevel | None:
        (source, target), made = self._present(), self.made
        if target.mode == "EDIT" or made is None:
            return None
        self._schedule.drop()
        try:
            run = FullLevel(context, source, target, made.region, made.arguments)
        except JobError as error:
            self.wait(str(error))
            return None
        self._schedule.run = run
        return run

    def _finish(self, context: Context) -> None:
        made, full, self._schedule.run = self.made, self._schedule.run, None
        assert made is not None and full is not None
        if full.error is not None:
            self.wait(full.error)
            return
        if self._present()[1].mode == "EDIT":
            self._schedule.plan()
            return
        job = full.job
        target = job.write(context, self._own)
        self._own = None
        self.level, self.triangles = job.settings.levels, job.triangles
        # the same faces: the next edit only moves them
        made.mesh = session_key(target.data) if job.settings.levels == made.level else None
        if full.fresh.solver is not None:
            made.solver, made.arguments = full.fresh.solver, full.arguments
            made.edge_length = job.edge_length

    def lend(self) -> None:
        """Returns its own data to the surface until the next edit: for a file that is saved."""
        own, target = self._own, self._target.find()
        if own is not None and target is not None and target.mode != "EDIT":
            self._write_anew()
            own.write_keys(target, last=False)

    def release(self, hand_back: bool = True) -> None:
        """Returns its own data to the surface; drops them if its mesh is not the one written."""
        own, self._own = self._own, None
        target = self._target.find()
        if own is None:
            return
        self._write_anew()
        if hand_back and target is not None and target.mode != "EDIT":
            own.write_keys(target)
        else:
            own.drop()

    @property
    def full_text(self) -> str:
        """Progress of the full level, in words; empty if none is computed."""
        run = self._schedule.run
        return progress_text(run) if run is not None else ""

    @property
    def slower(self) -> list[str]:
        """Settings that are reduced during edits, a line each."""
        return self.made.slower if self.made is not None and self.updates else []
