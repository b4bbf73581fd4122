# SPDX-License-Identifier: GPL-3.0-or-later
"""One live surface: its source, solver and mesh. Called by `handlers` on the main thread."""

from collections.abc import Collection
from contextlib import AbstractContextManager
from time import perf_counter
from typing import Any, TypeAlias

import bpy
import numpy as np

from .. import core, errors, memory, size
from ..blender import Context, Mesh, Object, current_context, scene_of
from ..core import ControlArrays
from ..errors import JobError
from ..inspection import display, overlay
from ..memory import source_of
from ..mesh.layers import read_data
from ..mesh.object import Reference, session_key
from ..mesh.own import OwnData, carried_names, read_own, write_own
from ..mesh.read import control_mesh, group_values, read_mesh, selected_faces
from ..mesh.world_shape import WorldShape, world_shape
from ..mesh.write import has_faces_of, write_positions, write_surface
from ..preferences import preferences
from ..queue import progress_text
from ..settings import Settings, halves, is_evaluated
from ..surfaces import joint_normals, place
from ..transfer.attributes import AttributeTransfer
from ..transfer.seams import sharp_pairs
from .dependencies import Dependencies
from .full_level import FullLevel, Schedule, is_dragging
from .pace import Deadline, Pace
from .registry import why_gone

# accurate enough for display, and usually one step an update; the full level has the core's default
# accuracy
_RESIDUAL = 1e-3
_STEP = 1e-2

# the dependency graph of the current update; None outside an update
Update: TypeAlias = bpy.types.Depsgraph | None

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
        self._mesh: int | None = None  # key of the mesh for which the solver was built
        self._schedule = Schedule()  # of the full level
        self._own: OwnData | None = None  # the surface's own data, for its full level
        self._forget()

    def _forget(self) -> None:
        """Drops everything that was made for other settings."""
        self.solver: Any = None
        self._arguments: Any = None
        self._arrays: Any = None
        self._settings: Any = None
        self._shape = WorldShape(None)
        self._dependencies = Dependencies()
        self._region: np.ndarray | None = None
        self._values: dict[str, np.ndarray] = {}  # from vertex groups
        # of the mesh that the solver was made for, which a drag does not change
        self._edge_length = 0.0
        self._chosen = 0
        self._pace = Pace()

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
        again = self._dependencies.are_awaited(source, target, moved)
        if self._stale or self._unseen or again or not its.isdisjoint(reshaped):
            return True
        return not self._has_settings_of(source, target)

    def mark_stale(self) -> None:
        """Notes that anything may have changed, as by undo. May be called on any thread."""
        self._stale, self._mesh = True, None

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
        if not self._has_settings_of(source, target):
            self._forget()
            self._settings = Settings.of(target.discrete_fairing)
            self._chosen = _chosen_level(target)
            self._shape = world_shape(source)
            self._dependencies.read(source, target, self._settings)
        elif self._dependencies.due and depsgraph is None:
            self._dependencies.read(source, target, self._settings)
        with self._mesh_now(source, depsgraph) as mesh:
            arrays = read_mesh(mesh)
            if not self._has_values_of(arrays):
                self._values = group_values(source, mesh, self._settings)
        is_new = self._prepare(source, arrays, depsgraph)
        if not (is_new or self._stale or self.trouble) and np.array_equal(
            arrays.positions, self._arrays.positions
        ):
            return False
        self.cancel_full()
        self._arrays = arrays
        result = self._solve(source, arrays, depsgraph)
        self._write(source, target, result, depsgraph)
        self.seconds, self.trouble = perf_counter() - began, ""
        if result.report["warm"] or not is_new:
            self._pace.note(self.level, self._arguments["energy"], self.seconds)
        self.updates += 1
        self._schedule.plan()
        return True

    def _mesh_now(self, source: Object, depsgraph: Update) -> AbstractContextManager[Mesh]:
        """The present control mesh, from Object Mode, Sculpt Mode or during an edit; read only."""
        return control_mesh(current_context(), source, is_evaluated(self._settings), depsgraph)

    def _solve(self, source: Object, arrays: ControlArrays, depsgraph: Update) -> Any:
        """The surface at a level and by an energy that are fast enough; finds these by trial if needed."""
        while True:
            deadline = Deadline()
            try:
                world = self._shape.of(arrays.positions)
                result = self.solver.solve(world, progress=deadline)
                result.vertices = self._shape.back(result.vertices, world, arrays.positions)
                return result
            except core.module().FairingError:
                if not deadline.is_over:
                    raise
                if not self._pace.slow_down(self._level, self._arguments["energy"], hopeless=True):
                    raise
            self._prepare(source, arrays, depsgraph)

    def _prepare(self, source: Object, arrays: ControlArrays, depsgraph: Update) -> bool:
        """Makes a solver unless the present one fits; returns whether it did."""
        if self._settings.use_selection and (
            self._region is None or not arrays.has_faces_of(self._arrays)
        ):
            with self._mesh_now(source, depsgraph) as mesh:
                self._region = selected_faces(mesh, source.name)
        computed = size.coarse_triangles(arrays.face_sizes) * halves(self._settings)
        self._pace.least = 2 if "neighbour" in self._dependencies.arguments else 1
        self._level = self._pace.level(self._chosen, computed)
        world = self._shape.of_arrays(arrays)
        if not (self._edge_length and arrays.has_faces_of(self._arrays)):
            self._edge_length = world.mean_edge_length
        arguments = core.fair_arguments(
            world,
            self._settings,
            preferences(),
            self._region,
            edge_length=self._edge_length,
            **self._values,
        )
        arguments |= {
            "levels": self._level,
            "relative_residual": _RESIDUAL,
            "step_tolerance": _STEP,
        }
        arguments["energy"] = self._pace.energy(arguments["energy"])
        arguments |= self._dependencies.arguments
        if (
            self.solver is not None
            and core.are_equal(
                core.without_vertices(arguments), core.without_vertices(self._arguments)
            )
            and core.are_together(arrays.positions, self.solver.vertex_origin)
        ):
            return False
        self.solver = self._mesh = None
        self.solver = core.solver(arguments)
        self._arguments = arguments
        return True

    def _write(self, source: Object, target: Object, result: Any, depsgraph: Update) -> None:
        if self._mesh != session_key(target.data) or not has_faces_of(target.data, result):
            with self._mesh_now(source, depsgraph) as mesh:
                data = read_data(source, mesh, is_evaluated(self._settings))
            if self._own is None:
                carried = memory.recall(target, "carried") or {}
                self._own = read_own(target, carried_names(data, data.shape_keys), carried)
            pairs = sharp_pairs(result, self._arrays, self._settings, self._level)
            transfer = AttributeTransfer(result, self._arrays, self._level)
            its = result, pairs, data, transfer, self._settings
            write_surface(target, *its, operators=False)
            if self._own is not None:
                write_own(target, self._own, in_handler=True)
            self._mesh = session_key(target.data)
            if not target.discrete_fairing.unfinished:
                target.discrete_fairing.unfinished = True
        else:
            write_positions(target.data, result.vertices)
        joint_normals.update(current_context(), target, depsgraph)
        overlay.moved(target)
        display.remeasure(target, scene_of(target).discrete_fairing_inspection)
        self.level = self._level
        self.triangles = len(result.faces[0]) + 2 * len(result.faces[1])
        self._stale = False

    def wait(self, sentence: str) -> None:
        """Keeps the last good surface until the source is valid again; `sentence` describes its fault."""
        self.cancel_full()
        self.trouble = sentence
        self._stale = False
        self._schedule.drop()

    def _has_settings_of(self, source: Object, target: Object) -> bool:
        """The scale of the source counts as a setting."""
        return (
            self._settings == Settings.of(target.discrete_fairing)
            and self._chosen == _chosen_level(target)
            and self._shape == world_shape(source)
            and self._dependencies.are_of(target)
        )

    def _has_values_of(self, arrays: ControlArrays) -> bool:
        """Whether values from groups are unchanged: a drag changes none, and reading is slow."""
        return (
            self._arrays is not None
            and not is_evaluated(self._settings)
            and is_dragging(current_context())
            and arrays.has_faces_of(self._arrays)
        )

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
        if self._unseen or self._dependencies.due:
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
        source, target = self._present()
        if target.mode == "EDIT":
            return None
        self._schedule.drop()
        try:
            run = FullLevel(context, source, target, self._region, self._arguments)
        except JobError as error:
            self.wait(str(error))
            return None
        self._schedule.run = run
        return run

    def _finish(self, context: Context) -> None:
        full, self._schedule.run = self._schedule.run, None
        assert full is not None
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
        self._mesh = session_key(target.data) if job.settings.levels == self._level else None
        if full.fresh.solver is not None:
            self.solver, self._arguments = full.fresh.solver, full.arguments
            self._edge_length = job.edge_length

    def lend(self) -> None:
        """Returns its own data to the surface until the next edit: for a file that is saved."""
        own, target = self._own, self._target.find()
        if own is not None and target is not None and target.mode != "EDIT":
            self._mesh = None
            own.write_keys(target, last=False)

    def release(self, hand_back: bool = True) -> None:
        """Returns its own data to the surface; drops them if its mesh is not the one written."""
        own, self._own = self._own, None
        target = self._target.find()
        if own is None:
            return
        self._mesh = None
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
        if self._settings is None or not self.updates:
            return []
        less = ["Bending while editing"] if self._pace.is_plain else []
        if self._level < self._chosen:
            less.append(f"Level {self._level} instead of {self._chosen}, to keep up")
        return less


def _chosen_level(target: Object) -> int:
    return min(target.discrete_fairing_live.levels, target.discrete_fairing.levels)
