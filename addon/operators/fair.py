# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface, Recompute and Show Source.

All work is reachable from `execute`, which scripts and background runs call.
"""

from typing import cast

import bpy

from .. import core
from ..blender import Answer, Context, Object, registration
from ..errors import JobError
from ..job import Job
from ..mesh.object import select_only
from ..mesh.read import source_objects
from ..poll import ExplainedPoll
from ..queue import ConsoleProgress, running
from ..settings import FairingSettings
from ..ui.layout import draw_settings
from .modal import ModalRun

# triangles; fewer are done before a progress bar could be read, by the fastest energy
IMMEDIATE = 200_000
TIMES_AS_LONG = {"THIN_PLATE": 1, "TOTAL_CURVATURE": 5, "MINIMUM_VARIATION": 15}


def poll_reason(context: Context) -> str:
    """Why nothing can be faired here, in one sentence; empty when it can."""
    if core.why_missing():
        return core.why_missing()
    if running():
        return "A surface is being faired at this moment"
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        return "Fairing works in Object Mode and Edit Mode"
    return ""


class _Fairing(ExplainedPoll, ModalRun):
    """What both operators share: jobs are made, computed, and only when all are done something is
    written.
    """

    def invoke(self, context: Context, _event: bpy.types.Event) -> Answer:
        jobs = self._prepare(context)
        if jobs is None:
            return {"CANCELLED"}
        if sum(job.triangles * TIMES_AS_LONG[job.settings.energy] for job in jobs) > IMMEDIATE:
            return self.start(context, jobs)
        return self._block(context, jobs)

    def execute(self, context: Context) -> Answer:
        jobs = self._prepare(context)
        return {"CANCELLED"} if jobs is None else self._block(context, jobs)

    def _prepare(self, context: Context) -> list[Job] | None:
        """The jobs, or None after an error has been reported."""
        try:
            return self.make_jobs(context)
        except JobError as error:
            self.report({"ERROR"}, str(error))
            return None

    def _block(self, context: Context, jobs: list[Job]) -> Answer:
        try:
            for job in jobs:
                job.compute(
                    **({"progress": ConsoleProgress(job.name)} if bpy.app.background else {})
                )
        except JobError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self.finish(context, jobs)

    def finish(self, context: Context, jobs: list[Job]) -> Answer:
        """Writes what finished jobs have computed, in Object Mode."""
        gone = [job.name for job in jobs if not job.is_writable()]
        if gone:
            self.report(
                {"ERROR"}, f"{', '.join(gone)} was deleted during the run: nothing has been made."
            )
            return {"CANCELLED"}
        if context.mode == "EDIT_MESH":
            bpy.ops.object.mode_set(mode="OBJECT")
        written = [job.write(context) for job in jobs]
        for job in jobs:
            for sentence in job.notes:
                self.report({"INFO"}, f"{job.name}: {sentence}")
            for sentence in job.warnings():
                self.report({"WARNING"}, sentence)
        select_only(context, written)
        self.after(context, jobs)
        return {"FINISHED"}

    def make_jobs(self, context: Context) -> list[Job]:
        """What is to be computed; raises JobError."""
        raise NotImplementedError

    def after(self, context: Context, jobs: list[Job]) -> None:
        """For what is not common to both."""


class OBJECT_OT_fair_surface(_Fairing, FairingSettings, bpy.types.Operator):
    """Make a new object: the fairest surface through the vertices of this mesh. The mesh itself stays as it is"""

    bl_idname = "object.fair_surface"
    bl_label = "Fair Surface"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    @staticmethod
    def poll_reason(context: Context) -> str:
        return poll_reason(context) or (
            "" if source_objects(context) else "Select a mesh object first"
        )

    def draw(self, _context: Context) -> None:
        draw_settings(cast(bpy.types.UILayout, self.layout), self, self.bl_idname)

    def make_jobs(self, context: Context) -> list[Job]:
        return [Job(context, source, self) for source in source_objects(context)]

    def after(self, context: Context, jobs: list[Job]) -> None:
        for job in jobs:
            if self.hide_source and context.view_layer.objects.get(job.source.name) == job.source:
                job.source.hide_set(True)


def faired_objects(context: Context) -> list[Object]:
    """The selected objects that remember a source; the active one alone if none."""
    selected = [
        o for o in context.selected_objects if o.type == "MESH" and o.discrete_fairing.source
    ]
    active = context.active_object
    if (
        not selected
        and active is not None
        and active.type == "MESH"
        and active.discrete_fairing.source
    ):
        selected = [active]
    return sorted(selected, key=lambda o: o == active)


class OBJECT_OT_fairing_recompute(_Fairing, bpy.types.Operator):
    """Compute this surface again from its source as it is now, with the settings below. Materials and modifiers added since then stay"""

    bl_idname = "object.fairing_recompute"
    bl_label = "Recompute"
    bl_options = {"REGISTER", "UNDO"}

    @staticmethod
    def poll_reason(context: Context) -> str:
        if poll_reason(context):
            return poll_reason(context)
        targets = faired_objects(context)
        if not targets:
            return "Select a faired surface whose source still exists"
        if any(target.data.library or target.library for target in targets):
            return "A linked object cannot be changed"
        return ""

    def make_jobs(self, context: Context) -> list[Job]:
        return [
            Job(context, target.discrete_fairing.source, target.discrete_fairing, target)
            for target in faired_objects(context)
        ]


class OBJECT_OT_fairing_show_source(ExplainedPoll, bpy.types.Operator):
    """Show the source of this surface and select it, to work on its vertices"""

    bl_idname = "object.fairing_show_source"
    bl_label = "Show Source"
    bl_options = {"REGISTER", "UNDO"}

    @staticmethod
    def poll_reason(context: Context) -> str:
        active = context.active_object
        if context.mode != "OBJECT":
            return "Go to Object Mode first"
        if active is None or active.type != "MESH" or active.discrete_fairing.source is None:
            return "Select a faired surface whose source still exists"
        source = active.discrete_fairing.source
        if context.view_layer.objects.get(source.name) != source:
            return f"'{source.name}' is not in this view layer"
        return ""

    def execute(self, context: Context) -> Answer:
        active = context.active_object
        assert active is not None  # as poll_reason has seen
        source = active.discrete_fairing.source
        source.hide_set(False)
        select_only(context, [source])
        return {"FINISHED"}


CLASSES = (OBJECT_OT_fair_surface, OBJECT_OT_fairing_recompute, OBJECT_OT_fairing_show_source)

register, unregister = registration(*CLASSES)
