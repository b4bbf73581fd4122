# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator: read, fair, write. All work is reachable from `execute`, which scripts and background runs call."""

import bpy

from . import messages, native, size
from .lattice import fine_edges
from .read_mesh import read_object
from .request import fair_arguments
from .settings import FairingSettings
from .settings_layout import draw_advanced, draw_creases, draw_shape
from .write_mesh import write_mesh
from .write_object import select_only, write_object


def source_objects(context):
    """The meshes to fair: the selected ones in Object Mode, those being edited in Edit Mode; the active one alone if none."""
    active = context.active_object
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    selected = [o for o in context.selected_objects if o.type == "MESH"]
    if not selected and active is not None and active.type == "MESH":
        selected = [active]
    return sorted(
        selected, key=lambda o: o == active
    )  # the active one last, so that its result becomes active


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
        sources = source_objects(context)
        faired = []
        for (
            source
        ) in sources:  # all are computed before anything is made: an error leaves the scene as it was
            arrays = read_object(source)
            arguments = fair_arguments(arrays, self)
            result = self._fair(source.name, arguments)
            if result is None:
                return {"CANCELLED"}
            faired.append(
                (source, arrays, result, fine_edges(result.faces, result.crease_edges, self.levels))
            )

        if context.mode == "EDIT_MESH":
            bpy.ops.object.mode_set(mode="OBJECT")
        created = []
        for source, arrays, result, sharp_pairs in faired:
            name = f"{source.name} Fair"
            mesh = write_mesh(name, result, arrays, sharp_pairs, source.data.materials, self.shade_smooth)
            created.append(write_object(context, source, mesh, result.report))
            for warning in result.report["warnings"]:
                self.report({"WARNING"}, messages.warning_text(source.name, warning))
        select_only(context, created)
        return {"FINISHED"}

    def _fair(self, name, arguments):
        """The core's result for the object of that name; None after an error has been reported."""
        core = native.core()
        _corners, offsets = arguments["faces"]
        too_large = size.why_too_large(size.triangle_count(offsets[1:] - offsets[:-1], self.levels))
        if too_large:
            self.report({"ERROR"}, f"{name}: {too_large}.")
            return None
        try:
            return core.fair(**arguments)
        except core.FairingError as error:
            self.report({"ERROR"}, messages.error_text(name, error))
            return None


def register():
    bpy.utils.register_class(OBJECT_OT_fair_surface)


def unregister():
    bpy.utils.unregister_class(OBJECT_OT_fair_surface)
