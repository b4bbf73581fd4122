# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface, Recompute and Show Source; scripts and background runs call `execute`."""

from collections.abc import Sequence
from typing import Any, cast

import bpy

from .. import core, prediction
from ..blender import Answer, Context, Object
from ..errors import JobCancelled, JobError
from ..jobs.fair import Job
from ..jobs.fit import job_of
from ..live import switch
from ..live.pace import Deadline
from ..memory import no_source_reason, scans_of, source_of
from ..mesh.object import is_in_view_layer, nothing_left_behind, select_only, why_not_here
from ..mesh.read import control_meshes, source_objects
from ..poll import IN_EITHER_MODE, LINKED_SURFACE, ExplainedPoll, in_mode, needs
from ..properties import FairingSettings, copy_settings, fill_in, take_near
from ..queue import ConsoleProgress, running
from ..settings import Settings
from ..surfaces import curve_cage
from ..surfaces.freshness import is_own, stale_surfaces
from ..ui.layout import draw_settings
from ..words import counted
from . import modal
from .mixins import Action, refusing
from .modal import ModalRun


def can_fair(context: Context) -> str:
    """Why nothing can be faired here, in one sentence; empty if something can."""
    if core.why_missing():
        return core.why_missing()
    if running() is not None:
        return "Wait, or press ESC: a surface is being faired at this moment"
    return IN_EITHER_MODE(context)


class Fairing(ExplainedPoll, ModalRun):
    """The common part of both operators: makes jobs, computes them, and writes once all are complete."""

    def invoke(self, context: Context, _event: bpy.types.Event) -> Answer:
        return self.begin(context)

    @refusing
    def begin(self, context: Context) -> Answer:
        """Starts the run as a button does."""
        jobs = self._prepared(context)
        return self._in_time(context, jobs) or self.start(context, self._unused(context, jobs))

    @refusing
    def execute(self, context: Context) -> Answer:
        jobs = self._prepared(context)
        if not self.is_redone():
            return self._block(context, jobs)
        return self._in_time(context, jobs) or self._begin_small(context, jobs)

    def is_redone(self) -> bool:
        """Whether Adjust Last Operation is calling, which blocks and cannot be cancelled."""
        return self.options.is_repeat and not bpy.app.background

    def _in_time(self, context: Context, jobs: list[Job]) -> Answer | None:
        """Makes the surfaces at once; None if the predicted or the actual time is too long to wait."""
        if modal.predicted_seconds(jobs) > prediction.PATIENCE:
            return None
        try:
            return self._block(context, jobs, Deadline(prediction.PATIENCE))
        except JobCancelled:
            return None

    def _unused(self, context: Context, jobs: list[Job]) -> list[Job]:
        """The `jobs`, or new ones if some have been computed already."""
        return jobs if all(job.result is None for job in jobs) else self._prepared(context)

    def _begin_small(self, context: Context, tried: list[Job]) -> Answer:
        """Makes surfaces of fewer levels, for Recompute to complete; JobError if too slow."""
        jobs = self._unused(context, tried)
        try:
            self._block(context, modal.small_jobs(context, jobs), Deadline(modal.BUDGET))
        except JobCancelled as error:
            raise JobError(
                "This takes too long here: set it in the panel, and press Recompute"
            ) from error
        for target, job in zip(self._written, jobs, strict=True):
            copy_settings(job.settings, target.discrete_fairing)
            target.discrete_fairing.unfinished = True
        self.report({"INFO"}, "Shown with fewer levels: press Recompute for the whole surface")
        return {"FINISHED"}

    def _prepared(self, context: Context) -> list[Job]:
        self._mode = context.mode
        return self.make_jobs(context)

    def _block(self, context: Context, jobs: list[Job], deadline: Deadline | None = None) -> Answer:
        """Computes all jobs while blocking; raises JobCancelled if the deadline passes."""
        for job in jobs:
            console = ConsoleProgress(job.name) if bpy.app.background else None
            progress = deadline or console
            job.compute(**({"progress": progress} if progress else {}))
        self.finish(context, jobs)
        return {"FINISHED"}

    def finish(self, context: Context, jobs: Sequence[Job]) -> None:
        """Writes the results of finished jobs, and selects them in Object Mode."""
        gone = [job.name for job in jobs if not job.is_writable()]
        if gone:
            raise JobError(
                f"Fair once more: {', '.join(gone)} was deleted or undone during the run, and nothing has been made."
            )
        targets = [target for job in jobs if (target := job.target) is not None]
        # the user's present mode stays, unless the surfaces themselves are being edited
        busy = context.mode not in {"OBJECT", self._mode}
        busy = busy and all(target.mode == "OBJECT" for target in targets)
        if context.mode != "OBJECT" and not busy:
            bpy.ops.object.mode_set(mode="OBJECT")
        with nothing_left_behind():
            self._written = [job.write(context) for job in jobs]
        for job in jobs:
            self.tell(job)
        if not busy:
            select_only(context, self._written)
        self.after(context, jobs)

    def tell(self, job: Job) -> None:
        for sentence in job.notes:
            self.report({"INFO"}, f"{job.name}: {sentence}")
        for sentence in job.warnings():
            self.report({"WARNING"}, sentence)

    def make_jobs(self, context: Context) -> list[Job]:
        """The jobs to compute; raises JobError."""
        raise NotImplementedError

    def after(self, context: Context, jobs: Sequence[Job]) -> None:
        """A hook for operators, after writing."""


class FairSurface(Fairing, FairingSettings):
    """Fair Surface without its identifier."""

    bl_idname: str
    bl_label = "Fair Surface"

    reasons = (can_fair, needs(source_objects, "Select a mesh object first"))

    def draw(self, _context: Context) -> None:
        draw_settings(cast(bpy.types.UILayout, self.layout), self, self.bl_idname)

    def invoke(self, context: Context, event: bpy.types.Event) -> Answer:
        """From buttons, menus and search: uses the settings of the panel."""
        take_near(self.properties)
        fill_in(context.scene.discrete_fairing, self.properties)
        return super().invoke(context, event)

    def execute(self, context: Context) -> Answer:
        take_near(self.properties)
        return super().execute(context)

    def make_jobs(self, context: Context) -> list[Job]:
        settings = Settings.of(self)
        jobs = [Job(context, source, settings) for source in control_meshes(context)]
        left = len(source_objects(context)) - len(jobs)
        if left:
            jobs[-1].notes.append(
                f"{counted(left, 'selected surface')} left as before: Recompute makes these again"
            )
        return jobs

    def after(self, context: Context, jobs: Sequence[Job]) -> None:
        for job in jobs:
            if self.hide_source:
                hide(context, cast(Object, job.source))  # `finish` has checked it


def hide(context: Context, source: Object) -> None:
    """Hides what a surface was made from, unless it is edited, as one with a live surface is."""
    edited = source.mode != "OBJECT" or switch.live_surfaces_of(source)
    if not edited and is_in_view_layer(context, source):
        source.hide_set(True)


class WholeFairing(Fairing):
    """A run without a smaller result: Adjust Last Operation starts a long one in the background."""

    def _begin_small(self, context: Context, _tried: list[Job]) -> Answer:
        modal.repeat_soon(context, self)
        return {"FINISHED"}


class InMeshes(WholeFairing):
    """Mix-in of runs that write to the meshes that they have read."""

    def finish(self, context: Context, jobs: Sequence[Any]) -> None:
        """Writes the meshes, unless one has changed during the run."""
        for reason in filter(None, (job.why_outdated(context) for job in jobs)):
            raise JobError(reason)
        self.write(context, jobs)

    def write(self, context: Context, jobs: Sequence[Any]) -> None:
        raise NotImplementedError


class OBJECT_OT_fairing_surface(FairSurface, bpy.types.Operator):
    """Make the fairest surface through the vertices of this mesh as a new object; the mesh is unchanged"""

    bl_idname = "object.fairing_surface"
    bl_options = {"REGISTER", "UNDO", "PRESET"}


def faired_objects(context: Context) -> list[Object]:
    """The selected objects that can be made from their source; the active one alone if there are none."""
    selected = [o for o in context.selected_objects if source_of(o)]
    active = context.active_object
    if not selected and active is not None and source_of(active):
        selected = [active]
    return sorted(selected, key=lambda o: o == active)


def _again(context: Context, target: Object) -> Job:
    """The job that recomputes `target`, after updating its source from its curves, if any."""
    source = cast(Object, source_of(target))
    remarks = curve_cage.follow(source).remarks if curve_cage.is_cage(source) else []
    job = job_of(context, source, Settings.of(target.discrete_fairing), target)
    job.notes += remarks
    return job


class OBJECT_OT_fairing_recompute(WholeFairing, bpy.types.Operator):
    """Make this surface again from its source as it is now, and keep its own materials and modifiers"""

    bl_idname = "object.fairing_recompute"
    bl_label = "Recompute"

    reasons = (
        can_fair,
        lambda c: "" if faired_objects(c) else no_source_reason(c.active_object),
        needs(lambda context: all(map(is_own, faired_objects(context))), LINKED_SURFACE),
    )

    def make_jobs(self, context: Context) -> list[Job]:
        return [_again(context, target) for target in faired_objects(context)]


class OBJECT_OT_fairing_recompute_stale(WholeFairing, bpy.types.Operator):
    """Compute all surfaces again whose source or settings have changed since they were made"""

    bl_idname = "object.fairing_recompute_stale"
    bl_label = "Recompute All Out of Date"

    reasons = (
        can_fair,
        needs(lambda _: any(stale_surfaces()), "Nothing to do: no surface is out of date"),
    )

    def make_jobs(self, context: Context) -> list[Job]:
        return [_again(context, target) for target in stale_surfaces()]


class OBJECT_OT_fairing_show_source(Action, bpy.types.Operator):
    """Show the source of this surface, and its scans, and select it, to edit its vertices"""

    bl_idname = "object.fairing_show_source"
    bl_label = "Show Source"

    @staticmethod
    def _source_reason(context: Context) -> str:
        active = context.active_object
        source = source_of(active) if active is not None else None
        return no_source_reason(active) if source is None else why_not_here(context, [source])

    reasons = (in_mode("Go to Object Mode first", "OBJECT"), _source_reason)

    def act(self, context: Context) -> None:
        surface = cast(Object, context.active_object)
        source = source_of(surface)
        assert source is not None  # poll has checked it
        for target in (source, *scans_of(surface)):
            if is_in_view_layer(context, target):
                target.hide_set(False)
        select_only(context, [source])
