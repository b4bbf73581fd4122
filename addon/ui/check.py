# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Check": defects of the mesh, and buttons that mend them."""

from math import degrees
from typing import Any

import bpy

from .. import errors
from ..blender import Context
from ..check import joints
from ..check.defects import recall_cleaned, recall_defects, recall_holes
from ..check.holes import MOST
from ..jobs.clean import repair_label
from ..units import Units
from .layout import Folded, draw_notice

_SHOWN = 8  # rows; more kinds of defects are unlikely


class VIEW3D_PT_fairing_check(Folded, bpy.types.Panel):
    bl_label = "Check"

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.operator("object.fairing_check", icon="CHECKMARK")
        layout.operator("object.fairing_clean", icon="BRUSH_DATA")
        layout.operator("object.fairing_joints", icon="SNAP_EDGE")
        _draw_joints(layout, context)
        target = context.active_object
        if target is None or target.type != "MESH":
            return
        known = recall_defects(target)
        if known is None:
            return
        defects, stale = known
        for sentence in recall_cleaned(target):
            draw_notice(layout, sentence, icon="DOT")
        if stale:
            draw_notice(layout, "The mesh was changed since: press Check Mesh again", icon="INFO")
        elif not defects:
            draw_notice(layout, "Nothing is wrong with this mesh", icon="CHECKMARK")
        for index, defect in enumerate(defects[:_SHOWN]):
            _draw_defect(layout, index, defect, stale)
        _draw_holes(layout, context, recall_holes(target), stale)


def _draw_joints(layout: bpy.types.UILayout, context: Context) -> None:
    """Such as `Bonnet Fair, Fender Fair`, gap, kink and jump, with a button to the worst place."""
    found = joints.rows()
    text = Units.of(context.scene).lengths(max((row.gap for row in found), default=0.0))
    for index, joint in enumerate(found[:_SHOWN]):
        column = layout.column(align=True)
        row = column.row(align=True)
        row.label(text=", ".join(joint.names), icon="SNAP_EDGE")
        button: Any = row.operator(
            "object.fairing_select_joint", text="", icon="RESTRICT_SELECT_OFF"
        )
        button.index = index
        figures = f"{degrees(joint.kink):.2f}° kink, {100 * joint.jump:.1f} % curvature"
        column.label(text=f"{figures}, {text(joint.gap)} gap", icon="BLANK1")


def _draw_defect(
    layout: bpy.types.UILayout, index: int, defect: dict[str, Any], stale: bool
) -> None:
    column = layout.column(align=True)
    column.active = not stale
    icon = "CANCEL" if defect["severity"] == "error" else "INFO"
    draw_notice(column, f"{errors.what(defect)} {errors.remedy(defect['code'])}", icon=icon)
    row = column.row(align=True)
    if defect["elements"]:
        row.operator("object.fairing_select_defect", icon="RESTRICT_SELECT_OFF").index = index
    label = repair_label(defect["code"])
    if label:
        row.operator("object.fairing_repair", text=label, icon="TOOL_SETTINGS").index = index


def _draw_holes(
    layout: bpy.types.UILayout, context: Context, holes: list[dict[str, Any]], stale: bool
) -> None:
    if not holes:
        return
    column = layout.column(align=True)
    column.active = not stale
    column.label(text="Holes")
    text = Units.of(context.scene).lengths(holes[0]["width"])
    for hole in holes[:_SHOWN]:
        row = column.row(align=True)
        row.label(text=f"{text(hole['width'])} wide, {hole['edges']:,} edges", icon="MESH_CIRCLE")
        show = row.operator("object.fairing_select_hole", text="", icon="RESTRICT_SELECT_OFF")
        show.edge = hole["at"]
        row.operator("object.fairing_fill", text="Fill").edge = hole["at"]
    if len(holes) > _SHOWN:
        more = "" if len(holes) < MOST else "at least "
        column.label(text=f"and {more}{len(holes) - _SHOWN} smaller ones")
