# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface and Recompute. All work is reachable from `execute`, which scripts and background runs call."""

import bpy

from .. import native
from ..read.source import source_objects
from ..refusal import Refusing
from ..settings.layout import draw_settings
from ..settings.properties import FairingSettings
from ..write.object import select_only
from .job import Job
from .job_error import JobError
from .modal import ModalRun, running
from .progress import ConsoleProgress

IMMEDIATE = 200_000  # triangles; fewer are done before a progress bar could be read, by the fastest energy
TIMES_AS_LONG = {"THIN_PLATE": 1, "TOTAL_CURVATURE": 5, "MINIMUM_VARIATION": 15}


def why_not(context):
    """Why nothing can be faired here, in one sentence; empty when it can."""
    if native.why_missing():
        return native.why_missing()
    if running():
        return "A surface is being faired at this moment"
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        return "Fairing works in Object Mode and Edit Mode"
    return ""


class _Fairing(Refusing, ModalRun):
    """What both operators share: jobs are made, computed, and only when all are done something is written."""

    def invoke(self, context, _event):
        jobs = self._prepare(context)
        if jobs is None:
            return {"CANCELLED"}
        if sum(job.triangles * TIMES_AS_LONG[job.settings.energy] for job in jobs) > IMMEDIATE:
            return self.start(context, jobs)
        return self._block(context, jobs)

    def execute(self, context):
        jobs = self._prepare(context)
        return {"CANCELLED"} if jobs is None else self._block(context, jobs)

    def _prepare(self, context):
        """The jobs, or None after an error has been reported."""
        try:
            return self.make_jobs(context)
        except JobError as error:
            self.report({"ERROR"}, str(error))
            return None

    def _block(self, context, jobs):
        try:
            for job in jobs:
                job.compute(**({"progress": ConsoleProgress(job.name)} if bpy.app.background else {}))
        except JobError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self.finish(context, jobs)

    def finish(self, context, jobs):
        """Writes what finished jobs have computed, in Object Mode."""
        gone = [job.name for job in jobs if not job.is_writable()]
        if gone:
            self.report({"ERROR"}, f"{', '.join(gone)} was deleted meanwhile: nothing has been made.")
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

    def after(self, context, jobs):
        """For what is not common to both."""


class OBJECT_OT_fair_surface(_Fairing, FairingSettings, bpy.types.Operator):
    """Make a new object: the fairest surface through the vertices of this mesh. The mesh itself stays as it is"""

    bl_idname = "object.fair_surface"
    bl_label = "Fair Surface"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    @staticmethod
    def why_not(context):
        return why_not(context) or ("" if source_objects(context) else "Select a mesh object first")

    def draw(self, _context):
        draw_settings(self.layout, self, self.bl_idname)

    def make_jobs(self, context):
        return [Job(context, source, self) for source in source_objects(context)]

    def after(self, context, jobs):
        for job in jobs:
            if self.hide_source and context.view_layer.objects.get(job.source.name) == job.source:
                job.source.hide_set(True)


def faired_objects(context):
    """The selected objects that remember a source; the active one alone if none."""
    selected = [o for o in context.selected_objects if o.type == "MESH" and o.discrete_fairing.source]
    active = context.active_object
    if not selected and active is not None and active.type == "MESH" and active.discrete_fairing.source:
        selected = [active]
    return sorted(selected, key=lambda o: o == active)


class OBJECT_OT_fair_recompute(_Fairing, bpy.types.Operator):
    """Compute this surface again from its source as that is now, with the settings below. Materials and modifiers that it has got meanwhile stay"""

    bl_idname = "object.fair_recompute"
    bl_label = "Recompute"
    bl_options = {"REGISTER", "UNDO"}

    @staticmethod
    def why_not(context):
        if why_not(context):
            return why_not(context)
        targets = faired_objects(context)
        if not targets:
            return "Select a faired surface whose source still exists"
        if any(target.data.library or target.library for target in targets):
            return "A linked object cannot be changed"
        return ""

    def make_jobs(self, context):
        return [
            Job(context, target.discrete_fairing.source, target.discrete_fairing, target)
            for target in faired_objects(context)
        ]


CLASSES = (OBJECT_OT_fair_surface, OBJECT_OT_fair_recompute)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
