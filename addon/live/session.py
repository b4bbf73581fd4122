# SPDX-License-Identifier: GPL-3.0-or-later
"""One live surface: its source, its solver, its mesh. Called by `watch`, on Blender's main thread."""

from time import monotonic, perf_counter

import bpy
import numpy as np

from .. import native
from ..check import messages
from ..inspection import display
from ..preferences import preferences
from ..request import size
from ..request.arguments import fair_arguments
from ..run.job_error import JobError
from ..settings.properties import snapshot
from . import update
from .full_level import PAUSE, FullLevel, is_editing
from .geometry import read_arrays, read_region, read_surface_data
from .inputs import fixed, same
from .pace import Deadline, Pace
from .reference import Reference, is_in_a_scene, key

# what is enough to look at, and mostly one step an update; the full level has the core's own accuracy
_RESIDUAL = 1e-3
_STEP = 1e-2

SOURCE_GONE = "The source was deleted: Live has ended"
SURFACE_GONE = "The surface was deleted: Live has ended"
SURFACE_EDITED = "The surface itself is being edited: Live waits"


class Session:
    """Follows the source of one faired object. `trouble`: why it cannot at this moment, a sentence; empty if it can."""

    def __init__(self, target):
        self._target = Reference(target)
        self.key = self._target.key
        self.ending = False  # switched off, but the full level is still to come
        self.trouble = ""
        self.level = 0  # of the surface shown last
        self.triangles = 0
        self.parts = {}  # milliseconds of the last update: read, build, solve, write
        self.updates = 0
        self.solver = None
        self._stale = True  # the mesh may not be what was written
        self._mesh = None  # key of the mesh that was built
        self._due = None  # when the full level may begin
        self._full = None
        self._forget()

    def _forget(self):
        """Everything that was made for other settings."""
        self.solver = self._arguments = self._arrays = self._region = self._settings = self._chosen = None
        self._pace = Pace()

    def objects(self):
        """(source, target), None for what is gone."""
        target = self._target.find()
        return (target.discrete_fairing.source if target is not None else None), target

    def why_gone(self):
        """Why there is nothing to follow any more, a sentence; empty if there is."""
        source, target = self.objects()
        if target is None or not is_in_a_scene(target):
            return SURFACE_GONE
        return SOURCE_GONE if source is None or not is_in_a_scene(source) else ""

    def needs_look(self, reshaped=()):
        """Whether the surface may be out of date; `reshaped`: keys of the data-blocks whose geometry has changed."""
        source, target = self.objects()
        if self._stale or key(source) in reshaped or key(source.data) in reshaped:
            return True
        return not self._has_settings_of(target)

    def distrust(self):
        """Anything may have changed unseen, as by undo. Only notes it: for any thread."""
        self._stale, self._mesh = True, None

    def follow(self, depsgraph):
        """Brings the surface up to date with source and settings, at the live level. True if anything had changed."""
        source, target = self.objects()
        if target.mode == "EDIT":
            self.trouble, self._stale = SURFACE_EDITED, True
            return False
        try:
            return self._follow(source, target, depsgraph)
        except JobError as error:
            self._fail(str(error))
        except native.core().FairingError as error:
            self._fail(messages.error_text(source.name, error))
        return True

    def _follow(self, source, target, depsgraph):
        clock = _Clock()
        if not self._has_settings_of(target):
            self._forget()
            self._settings, self._chosen = snapshot(target.discrete_fairing), _chosen_level(target)
        arrays = read_arrays(source, self._settings, depsgraph)
        clock.lap("read")
        is_new = self._prepare(source, arrays, depsgraph)
        if not (is_new or self._stale or self.trouble) and np.array_equal(
            arrays.positions, self._arrays.positions
        ):
            return False
        self.cancel_full()
        self._arrays = arrays
        clock.lap("build")
        result = self._solve(source, arrays, depsgraph)
        clock.lap("solve")
        self._write(source, target, result, depsgraph)
        clock.lap("write")
        if result.report["warm"] or not is_new:
            self._pace.note(self.level, self._arguments["energy"], clock.total / 1e3)
        self.parts, self.trouble = clock.parts, ""
        self.updates += 1
        self._due = monotonic() + PAUSE
        return True

    def _solve(self, source, arrays, depsgraph):
        """The surface at a level and by an energy that can be kept up with; found out by trying, where need be."""
        while True:
            deadline = Deadline()
            try:
                return self.solver.solve(arrays.positions, progress=deadline)
            except native.core().FairingError:
                if not deadline.is_over:
                    raise
                if not self._pace.slow_down(self._level, self._arguments["energy"], hopeless=True):
                    raise
            self._prepare(source, arrays, depsgraph)

    def _prepare(self, source, arrays, depsgraph):
        """Makes a solver unless the one at hand is for the same mesh and settings; whether it did."""
        if self._settings.use_selection and (self._region is None or not _same_faces(arrays, self._arrays)):
            self._region = read_region(source, self._settings, depsgraph)
        self._level = self._pace.level(self._chosen, size.coarse_triangles(arrays.face_sizes))
        arguments = fair_arguments(arrays, self._settings, preferences(), self._region)
        arguments |= {"levels": self._level, "relative_residual": _RESIDUAL, "step_tolerance": _STEP}
        arguments["energy"] = self._pace.energy(arguments["energy"])
        if self.solver is not None and same(fixed(arguments), fixed(self._arguments)):
            return False
        self.solver = self._mesh = None
        self.solver = native.core().Solver(**arguments)
        self._arguments = arguments
        return True

    def _write(self, source, target, result, depsgraph):
        if self._mesh != key(target.data) or not update.fits(target.data, result):
            data = read_surface_data(source, self._settings, depsgraph)
            update.build(target, result, self._arrays, data, self._settings, self._level)
            self._mesh = key(target.data)
        else:
            update.move(target, result)
        display.remeasure(target, bpy.context.scene.discrete_fairing_inspection)
        self.level = self._level
        self.triangles = len(result.faces[0]) + 2 * len(result.faces[1])
        self._stale = False

    def _fail(self, sentence):
        """The last good surface stays, until the source is fine again."""
        self.cancel_full()
        self.trouble = sentence
        self._stale = False
        self._due = None

    def _has_settings_of(self, target):
        return self._settings == snapshot(target.discrete_fairing) and self._chosen == _chosen_level(target)

    # --- the full level

    @property
    def is_waiting(self):
        """Whether the full level is still to come."""
        return self._due is not None or self._full is not None

    def cancel_full(self, wait=False):
        """An edit makes the run worthless; the full level is due again."""
        if self._full is not None:
            self._full.cancel(wait)
            self._full, self._due = None, monotonic() + PAUSE

    def advance(self, context):
        """Begins the full level when edits have paused, and writes it when it is there."""
        if self._full is not None and self._full.finished:
            self._finish(context)
        elif self._is_due(context) and self._begin(context):
            self._full.start()

    def _is_due(self, context):
        return self._due is not None and (self.ending or monotonic() >= self._due) and not is_editing(context)

    def complete(self, context):
        """The full level now, if it is due: for scripts, and where there is no window."""
        if self._due is None or not self._begin(context):
            return
        try:
            self._full.compute()
        except JobError as error:
            self._full = None
            self._fail(str(error))
            return
        self._finish(context)

    def _begin(self, context):
        source, target = self.objects()
        if target.mode == "EDIT":
            return False
        self._due = None
        try:
            self._full = FullLevel(context, source, target, self._region, self._arguments)
        except JobError as error:
            self._fail(str(error))
        return self._full is not None

    def _finish(self, context):
        full, self._full = self._full, None
        if full.error is not None:
            self._fail(full.error)
            return
        if self.objects()[1].mode == "EDIT":
            self._due = monotonic() + PAUSE
            return
        target = full.job.write(context)
        job = full.job
        self.level, self.triangles = job.settings.levels, job.triangles
        # the same faces: the next edit need only move them
        self._mesh = key(target.data) if job.settings.levels == self._level else None
        self.solver = full.solver or self.solver

    @property
    def full_text(self):
        """How far the full level is, in words; empty while none is computed."""
        return self._full.text if self._full is not None else ""

    @property
    def slower(self):
        """What is less than chosen during edits, a line each."""
        if self._settings is None or not self.updates:
            return []
        less = ["Thin Plate while editing"] if self._pace.is_plain else []
        if self._level < self._chosen:
            less.append(f"Level {self._level} instead of {self._chosen}, to keep up")
        return less


class _Clock:
    """Milliseconds of the parts of an update."""

    def __init__(self):
        self.parts = {}
        self._last = perf_counter()

    def lap(self, name):
        now = perf_counter()
        self.parts[name] = 1e3 * (now - self._last)
        self._last = now

    @property
    def total(self):
        return sum(self.parts.values())


def _chosen_level(target):
    return min(target.discrete_fairing_live.levels, target.discrete_fairing.levels)


def _same_faces(a, b):
    return b is not None and same((a.corners, a.offsets), (b.corners, b.offsets))
