# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Check": what is wrong with the mesh, and how to mend it."""

import bpy

from ..check import messages, record, repair
from ..check.operators import MESH_OT_fairing_check, MESH_OT_fairing_repair, MESH_OT_fairing_select_defect
from .notice import draw_notice

_SHOWN = 8  # lines; a mesh with more kinds of defects has not been seen


class VIEW3D_PT_fairing_check(bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Fairing"
    bl_parent_id = "VIEW3D_PT_fairing"
    bl_options = {"DEFAULT_CLOSED"}
    bl_label = "Check"

    def draw(self, context):
        layout = self.layout
        layout.operator(MESH_OT_fairing_check.bl_idname, icon="CHECKMARK")
        target = context.active_object
        known = record.recall(target) if target is not None and target.type == "MESH" else None
        if known is None:
            return
        defects, stale = known
        if stale:
            draw_notice(layout, "The mesh was changed since: press Check Mesh again", icon="INFO")
        elif not defects:
            draw_notice(layout, "Nothing is wrong with this mesh", icon="CHECKMARK")
        for index, defect in enumerate(defects[:_SHOWN]):
            _draw_defect(layout, index, defect, stale)


def _draw_defect(layout, index, defect, stale):
    column = layout.column(align=True)
    column.active = not stale
    icon = "CANCEL" if defect["severity"] == "error" else "INFO"
    draw_notice(column, f"{messages.what(defect)} {messages.remedy(defect['code'])}", icon=icon)
    row = column.row(align=True)
    if defect["elements"]:
        row.operator(MESH_OT_fairing_select_defect.bl_idname, icon="RESTRICT_SELECT_OFF").index = index
    label = repair.label(defect["code"])
    if label:
        row.operator(MESH_OT_fairing_repair.bl_idname, text=label, icon="TOOL_SETTINGS").index = index


CLASSES = (VIEW3D_PT_fairing_check,)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
