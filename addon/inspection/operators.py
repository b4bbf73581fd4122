# SPDX-License-Identifier: GPL-3.0-or-later
"""Buttons of the inspection: show, measure anew, read out, and turn the viewport so that it shows."""

import bpy
from bpy.props import EnumProperty

from ..refusal import Refusing
from . import display, readout
from .properties import MODES


def meshes(context):
    """The mesh objects that a button acts on: those selected, or else the active one."""
    chosen = [o for o in context.selected_objects if o.type == "MESH"]
    active = context.active_object
    return chosen or ([active] if active is not None and active.type == "MESH" else [])


def why_not(context):
    """Why nothing can be shown or measured here, in one sentence; empty when it can."""
    if context.mode != "OBJECT":
        return "Inspecting works in Object Mode: press Tab first"
    targets = meshes(context)
    if not targets:
        return "Select a mesh object first"
    if any(t.library or t.data.library for t in targets):
        return "This mesh is linked from another file: make it local first (Object > Relations > Make Local)"
    return ""


class _Inspecting(Refusing):
    bl_options = {"REGISTER", "UNDO"}

    why_not = staticmethod(why_not)


class OBJECT_OT_fairing_inspect(_Inspecting, bpy.types.Operator):
    """Show the selected objects in stripes or curvature colours. Their own materials stay and come back with Off"""

    bl_idname = "object.fairing_inspect"
    bl_label = "Inspect Surface"

    mode: EnumProperty(name="Show", description="What the objects show", items=MODES)

    @classmethod
    def description(cls, _context, properties):
        return next(text for key, _, text, *_ in MODES if key == properties.mode)

    def execute(self, context):
        for target in meshes(context):
            target.discrete_fairing_inspection.mode = self.mode
        return {"FINISHED"}


class OBJECT_OT_fairing_refresh(_Inspecting, bpy.types.Operator):
    """Measure the curvature anew, after the mesh was changed"""

    bl_idname = "object.fairing_refresh"
    bl_label = "Refresh Colours"

    def execute(self, context):
        for target in meshes(context):
            display.refresh(target, context.scene.discrete_fairing_inspection)
        return {"FINISHED"}


class OBJECT_OT_fairing_measure(_Inspecting, bpy.types.Operator):
    """Measure how fair the selected surfaces are, and the meshes they were made from"""

    bl_idname = "object.fairing_measure"
    bl_label = "Measure"

    def execute(self, context):
        for target in meshes(context):
            readout.take(context, target, readout.source_of(target))
        return {"FINISHED"}


class VIEW3D_OT_fairing_viewport(bpy.types.Operator):
    """Switch this viewport so that what is inspected can be seen"""

    bl_idname = "view3d.fairing_viewport"
    bl_label = "Show in This Viewport"

    shading: EnumProperty(
        name="Shading",
        description="How the viewport is drawn",
        items=(
            ("MATERIAL", "Material Preview", "Stripes and colours, as in a render"),
            ("ATTRIBUTE", "Solid with Attribute", "Curvature colours in Solid shading"),
        ),
    )

    @classmethod
    def poll(cls, context):
        if context.space_data is None or context.space_data.type != "VIEW_3D":
            cls.poll_message_set("Only in a 3D viewport")
            return False
        return True

    def execute(self, context):
        shading = context.space_data.shading
        shading.type = "MATERIAL" if self.shading == "MATERIAL" else "SOLID"
        if self.shading == "ATTRIBUTE":
            shading.color_type = "VERTEX"
        return {"FINISHED"}


CLASSES = (
    OBJECT_OT_fairing_inspect,
    OBJECT_OT_fairing_refresh,
    OBJECT_OT_fairing_measure,
    VIEW3D_OT_fairing_viewport,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
