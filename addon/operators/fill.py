# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjust Last Operation never waits: it shows a smaller surface, and the whole one follows.

Blender calls `execute` from there, which can neither be modal nor be cancelled.
"""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any, cast

import bpy

from .. import events, freshness, memory, place, prediction
from ..blender import Answer, Context, Object, current_context
from ..errors import JobError
from ..job import Job
from ..live import switch
from ..memory import source_of
from ..mesh.modifiers import copy_modifiers
from ..mesh.object import Reference, new_object
from ..mesh.own import carried_names
from ..queue import TimedJob, running
from ..settings import copy_settings, is_limit, wants_modifiers
from .modal import ModalRun

BUDGET = 0.5 * prediction.PATIENCE  # for computing; reading, writing and undo take time as well
_WITHOUT = "THIN_PLATE"  # stands in where another energy is too slow even for a small surface
_SOON = 0.1  # seconds; Live's own comes first
_due: list[Reference] = []  # the surfaces that are still to be made whole


def predicted_seconds(jobs: Sequence[TimedJob]) -> float:
    return sum(job.predicted_seconds for job in jobs)


def small_jobs(context: Context, jobs: Sequence[Job]) -> list[Job]:
    """Jobs in the place of `jobs` that take no longer than anyone would wait; raises JobError."""
    budget = BUDGET / len(jobs)
    return [Job(context, cast(Object, job.source), _small(job, budget), job.target) for job in jobs]


def _small(job: Job, budget: float) -> SimpleNamespace:
    """Its settings with as many levels, and if need be the energy, that the `budget` is enough for."""
    for energy, least in ((job.settings.energy, 2), (_WITHOUT, 2), (_WITHOUT, 1)):
        for levels in range(job.settings.levels, least - 1, -1):
            if job.predict(energy, levels) <= budget:
                return SimpleNamespace(**{**vars(job.settings), "levels": levels, "energy": energy})
    return SimpleNamespace(**{**vars(job.settings), "levels": 1, "energy": _WITHOUT})


class StandIn:
    """In the place of a job whose surface takes too long even when it is small: a new object has
    the control mesh, an old one stays as it is.
    """

    def __init__(self, job: Job) -> None:
        self._job = job
        self.name = job.name
        self.notes: list[str] = []

    @property
    def source(self) -> Object | None:
        return self._job.source

    @property
    def target(self) -> Object | None:
        return self._job.target

    def is_writable(self) -> bool:
        return self._job.is_writable()

    def write(self, context: Context) -> Object:
        """The object that is to be filled."""
        job = self._job
        source, target = cast(Object, job.source), job.target
        if target is None:
            mesh = source.data.copy()
            mesh.name = f"{job.name} Fair"
            target = new_object(context, source, mesh)
            memory.remember(target, source, job.settings, {})
            place.note(source, target)
            memory.keep(target, "carried", carried_names(job.data, job.keys))
            if wants_modifiers(job.settings):
                self.notes += copy_modifiers(context, source, target, is_limit(job.settings))
        return target

    def warnings(self) -> list[str]:
        return []


def fill_soon(context: Context, targets: Sequence[Object], jobs: Sequence[Job]) -> None:
    """Lets the small surfaces `targets` become those of `jobs`, which they remember from now on."""
    for target, job in zip(targets, jobs, strict=True):
        copy_settings(job.settings, target.discrete_fairing)
        target.discrete_fairing.unfinished = True
    _complete_soon(context, targets)


def _complete_soon(context: Context, targets: Sequence[Object]) -> None:
    _due[:] = map(Reference, targets)
    invoke_soon(context, cast(Any, bpy.ops.object).fairing_complete, {})


def _after_undo(*_: Any) -> None:
    """What is written outside of any step is undone with a later one: it is made anew."""
    if not bpy.app.background and not bpy.app.timers.is_registered(resume):
        bpy.app.timers.register(resume, first_interval=_SOON)


def resume() -> None:
    """Lets the unfinished surfaces that nobody else sees to become whole."""
    found = [
        target
        for target in freshness.known_surfaces()
        if target.discrete_fairing.unfinished and not switch.is_seen_to(target)
    ]
    if found and running() is None:
        _complete_soon(current_context(), found)


def invoke_soon(context: Context, operator: Any, properties: dict[str, Any]) -> None:
    """Calls an operator of bpy.ops as its button does, in the window at hand, once Blender is done with the
    present one; not at all where a run has begun meanwhile.
    """
    window = context.window
    if window is None:
        return
    place = list(context.window_manager.windows).index(window)

    def begin() -> None:
        manager = current_context().window_manager
        if place < len(manager.windows) and not running():
            with current_context().temp_override(window=manager.windows[place]):
                operator("INVOKE_DEFAULT", True, **properties)  # with a step of undo, as a button's

    bpy.app.timers.register(begin, first_interval=0.01)


def repeat_soon(context: Context, operator: Any) -> None:
    """Lets `operator`, which Adjust Last Operation has called and which would take too long there,
    begin anew with the same properties.
    """
    call = getattr(bpy.ops.object, operator.bl_idname.rpartition("_OT_")[2])
    invoke_soon(context, call, operator.as_keywords())


def give_way() -> None:
    """Ends what fills a surface, before a run that somebody has asked for."""
    _due.clear()
    queue = running()
    if queue is not None and queue.gives_way:
        queue.cancel()
        queue.join()


def due_jobs(context: Context) -> list[Job]:
    """The jobs of the surfaces that are still to be made whole; raises JobError."""
    targets = [target for reference in _due if (target := reference.find()) is not None]
    _due.clear()
    pairs = [(target, source_of(target)) for target in targets]
    return [Job(context, s, t.discrete_fairing, t) for t, s in pairs if s is not None]


def write_jobs(context: Context, jobs: Sequence[Job]) -> list[str]:
    """Fills the surfaces that are still there and not being edited; warnings, a sentence each."""
    said = []
    for job in jobs:
        if job.is_writable() and cast(Object, job.target).mode != "EDIT":
            job.write(context)
            said += job.warnings()
    return said


class OBJECT_OT_fairing_complete(ModalRun, bpy.types.Operator):
    """Make the surface whole that Adjust Last Operation has shown with fewer levels"""

    bl_idname = "object.fairing_complete"
    bl_label = "Complete Surface"
    bl_options = {"INTERNAL"}
    gives_way = True

    def invoke(self, context: Context, _event: bpy.types.Event) -> Answer:
        try:
            jobs = due_jobs(context)
        except JobError as error:
            self.report({"WARNING"}, str(error))  # nobody has asked just now
            return {"CANCELLED"}
        return self.start(context, jobs) if jobs else {"CANCELLED"}

    def finish(self, context: Context, jobs: list[Job]) -> Answer:
        for sentence in write_jobs(context, jobs):
            self.report({"WARNING"}, sentence)
        return {"FINISHED"}


_HANDLERS = {"undo_post": _after_undo, "redo_post": _after_undo}


def register() -> None:
    bpy.utils.register_class(OBJECT_OT_fairing_complete)
    events.listen(_HANDLERS)


def unregister() -> None:
    events.ignore(_HANDLERS)
    if bpy.app.timers.is_registered(resume):
        bpy.app.timers.unregister(resume)
    bpy.utils.unregister_class(OBJECT_OT_fairing_complete)
