# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Places: where a surface crosses itself, bulges or folds."""

from typing import cast

import bpy

from ..blender import Answer, Context, Object, registration
from ..check.defects import select_defects
from ..check.faults import faulty_vertices
from ..mesh.write import FAULTS
from ..poll import ExplainedPoll, mesh_poll_reason


class OBJECT_OT_fairing_select_faults(ExplainedPoll, bpy.types.Operator):
    """Select in Edit Mode where this surface crosses itself, bulges far from its source, or is folded"""

    bl_idname = "object.fairing_select_faults"
    bl_label = "Select Places"
    bl_options = {"REGISTER", "UNDO"}

    @staticmethod
    def poll_reason(context: Context) -> str:
        active = context.active_object
        if context.mode != "OBJECT":
            return "Go to Object Mode first"
        if active is None or active.type != "MESH":
            return "Select a faired surface first"
        if not any(name in active.data.attributes for name in FAULTS.values()):
            return "Nothing to do: nothing was found wrong with this surface"
        return mesh_poll_reason([active])

    def execute(self, context: Context) -> Answer:
        target = cast(Object, context.active_object)
        select_defects(context, target, "vertex", faulty_vertices(target.data).tolist())
        return {"FINISHED"}


register, unregister = registration(OBJECT_OT_fairing_select_faults)
