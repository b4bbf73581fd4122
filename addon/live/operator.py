# SPDX-License-Identifier: GPL-3.0-or-later
"""The switch Live."""

import bpy

from .. import native
from ..inspection import override
from ..refusal import Refusing
from ..write.modifiers import copy_modifiers
from ..write.object import new_object, remember
from . import switch
from .status import problem

_MODES = {"OBJECT", "EDIT_MESH", "SCULPT"}


class OBJECT_OT_fair_live(Refusing, bpy.types.Operator):
    """Let the faired surface follow while the control mesh is edited; the full level comes when the edit pauses. Makes the surface if there is none yet"""

    bl_idname = "object.fair_live"
    bl_label = "Live"
    bl_options = {"REGISTER", "UNDO"}

    state: bpy.props.EnumProperty(
        name="State",
        description="What becomes of Live",
        items=(
            ("TOGGLE", "Toggle", "On if it is off, off if it is on"),
            ("ON", "On", "The surface follows its source"),
            ("OFF", "Off", "The surface stays as it is, at its full level"),
        ),
    )

    @staticmethod
    def why_not(context):
        if native.why_missing():
            return native.why_missing()
        if context.mode not in _MODES:
            return "Live is switched in Object Mode, Edit Mode and Sculpt Mode"
        active = context.active_object
        if active is None or active.type != "MESH":
            return "Select a mesh object first"
        return switch.why_not(active) if active.discrete_fairing.source is not None else ""

    def execute(self, context):
        targets = switch.surfaces_at_hand(context)
        on = self.state == "ON" or (self.state == "TOGGLE" and not any(map(switch.is_on, targets)))
        if not on:
            for target in targets:
                switch.switch_off(target, context)
            return {"FINISHED"}
        for target in targets or [self._make(context)]:
            _show(context, target.discrete_fairing.source)
            switch.switch_on(target)
            if problem(target):
                self.report({"WARNING"}, problem(target))
        return {"FINISHED"}

    def _make(self, context):
        """A faired object of the active mesh, with the panel's settings; its first surface is a live one."""
        source, settings = context.active_object, context.scene.discrete_fairing
        mesh = bpy.data.meshes.new(f"{source.name} Fair")
        for material in source.data.materials:
            mesh.materials.append(material)
        target = new_object(context, source, mesh)
        remember(target, source, settings, {})
        if settings.copy_modifiers and settings.mesh_source == "ORIGINAL":
            if context.mode == "OBJECT":
                copy_modifiers(context, source, target)
                override.take_off(target)  # how the source is looked at is none of its modifiers
            else:
                self.report({"INFO"}, "Modifiers are copied in Object Mode only")
        return target


def _show(context, source):
    """What is hidden can neither be edited nor does Blender look at it."""
    if context.view_layer.objects.get(source.name) == source:
        source.hide_set(False)


def register():
    bpy.utils.register_class(OBJECT_OT_fair_live)


def unregister():
    bpy.utils.unregister_class(OBJECT_OT_fair_live)
