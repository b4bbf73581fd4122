# SPDX-License-Identifier: GPL-3.0-or-later
"""From a faired surface back to the mesh that controls it."""

import bpy

from ..refusal import Refusing
from ..write.object import select_only


class OBJECT_OT_fair_show_source(Refusing, bpy.types.Operator):
    """Show the source of this surface and select it, to work on its vertices"""

    bl_idname = "object.fair_show_source"
    bl_label = "Show Source"
    bl_options = {"REGISTER", "UNDO"}

    @staticmethod
    def why_not(context):
        active = context.active_object
        if context.mode != "OBJECT":
            return "Go to Object Mode first"
        if active is None or active.type != "MESH" or active.discrete_fairing.source is None:
            return "Select a faired surface whose source still exists"
        source = active.discrete_fairing.source
        if context.view_layer.objects.get(source.name) != source:
            return f"'{source.name}' is not in this view layer"
        return ""

    def execute(self, context):
        source = context.active_object.discrete_fairing.source
        source.hide_set(False)
        select_only(context, [source])
        return {"FINISHED"}


def register():
    bpy.utils.register_class(OBJECT_OT_fair_show_source)


def unregister():
    bpy.utils.unregister_class(OBJECT_OT_fair_show_source)
