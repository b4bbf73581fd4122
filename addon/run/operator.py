# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator: read, fair, write. All work is reachable from `execute`, which scripts and background runs call."""

import bpy

from .. import native
from ..read.source import source_objects
from ..request import size
from ..settings.layout import draw_advanced, draw_creases, draw_shape
from ..settings.properties import FairingSettings
from ..write.object import select_only
from .job import Job, JobError


def why_not(context):
    """Why the operator cannot run here, in one sentence; empty when it can."""
    if native.why_missing():
        return native.why_missing()
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        return "Fair Surface works in Object Mode and Edit Mode"
    if not source_objects(context):
        return "Select a mesh object first"
    return ""


class OBJECT_OT_fair_surface(FairingSettings, bpy.types.Operator):
    """Make a new object: the fairest surface through the vertices of this mesh. The mesh itself stays as it is"""

    bl_idname = "object.fair_surface"
    bl_label = "Fair Surface"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        reason = why_not(context)
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        draw_shape(layout, self)
        for label, draw in (("Creases", draw_creases), ("Advanced", draw_advanced)):
            header, body = layout.panel(f"{self.bl_idname}.{label}", default_closed=True)
            header.label(text=label)
            if body is not None:
                draw(body, self)

    def invoke(self, context, event):
        triangles = sum(
            size.triangle_count(size.face_sizes(o.data), self.levels) for o in source_objects(context)
        )
        if triangles < size.LARGE:
            return self.execute(context)
        return context.window_manager.invoke_confirm(
            self,
            event,
            title="Large Result",
            message=f"{size.count_text(triangles)}: this can take a while and Blender will not respond meanwhile",
            confirm_text="Fair Surface",
            icon="WARNING",
        )

    def execute(self, context):
        try:
            # all are computed before anything is made: an error leaves the scene as it was
            jobs = [Job(context, source, self) for source in source_objects(context)]
            for job in jobs:
                job.compute()
        except JobError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        write_all(context, jobs, self.report)
        return {"FINISHED"}


def write_all(context, jobs, report):
    """Makes the objects of finished jobs, in Object Mode, and selects them."""
    if context.mode == "EDIT_MESH":
        bpy.ops.object.mode_set(mode="OBJECT")
    created = []
    for job in jobs:
        created.append(job.write(context))
        for warning in job.warnings():
            report({"WARNING"}, warning)
    select_only(context, created)


def register():
    bpy.utils.register_class(OBJECT_OT_fair_surface)


def unregister():
    bpy.utils.unregister_class(OBJECT_OT_fair_surface)
