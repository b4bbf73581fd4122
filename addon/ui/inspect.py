# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Inspect": stripes, colours, and sections. Below it, folded: the control vertices that spoil the surface,
the tools of a boat yard, and defects of the mesh with buttons that mend them.
"""

from math import degrees
from typing import Any

import bpy

from .. import errors
from ..blender import Context, Object
from ..check import joints
from ..check.defects import MOST_HOLES, recall_cleaned, recall_defects, recall_holes
from ..inspection import display, viewport_shading
from ..inspection.display import VALUES
from ..inspection.materials import STRIPES
from ..inspection.settings import MODES
from ..jobs.clean import repair_label
from ..memory import active_source
from ..strain import cache
from ..strain.drawn import magnification
from ..strain.strained import Strained
from ..strain.words import looks_like_knuckle
from ..units import Units
from .layout import Folded, Sidebar, draw_notice, split


class VIEW3D_PT_fairing_inspect(Sidebar, bpy.types.Panel):
    bl_label = "Inspect"
    bl_order = 1  # below the panels that make surfaces

    def draw(self, context: Context) -> None:
        layout = self.layout
        target = context.active_object
        if target is not None and target.type != "MESH":
            target = None
        mode = target.discrete_fairing_inspection.mode if target is not None else "NONE"
        _draw_modes(layout, mode)
        split(layout)
        if mode != "NONE":
            if not viewport_shading.shows(context.space_data, mode):
                draw_notice(layout, "Switch this viewport to Material Preview to see it", "INFO")
            settings = context.scene.discrete_fairing_inspection
            if mode in VALUES:
                draw_range(layout, settings, mode)
            else:
                draw_stripes(layout, settings)
            layout.prop(settings, "smooth")
        if target is not None and mode in VALUES:
            _draw_legend(layout, context, target, mode)
        if target is not None:
            draw_sections(layout, target, context.scene.discrete_fairing_inspection)


def draw_stripes(layout: bpy.types.UILayout, settings: Any) -> None:
    for name in ("stripes", "direction", "sharpness", "fixed_to"):
        layout.prop(settings, name)


def draw_range(layout: bpy.types.UILayout, settings: Any, mode: str) -> None:
    if mode == "DEVIATION":
        layout.prop(settings, "deviation_object")
    layout.prop(settings, "use_fixed_range")
    if settings.use_fixed_range:
        layout.prop(settings, "fixed_deviation" if mode == "DEVIATION" else "fixed_range")


def draw_sections(layout: bpy.types.UILayout, target: Object, settings: Any) -> None:
    layout.prop(target.discrete_fairing_inspection, "sections")
    if target.discrete_fairing_inspection.sections:
        layout.row(align=True).prop(settings, "section_axes", expand=True)
        layout.prop(settings, "section_count")
        layout.prop(settings, "show_combs")
        if settings.show_combs:
            layout.prop(settings, "comb_scale")


def _draw_modes(layout: bpy.types.UILayout, current: str) -> None:
    labels = {mode: label for mode, label, *_ in MODES}
    column = layout.column(align=True)
    for part in (("NONE", *STRIPES), tuple(VALUES)):
        row = column.row(align=True)
        for mode in part:
            label = labels[mode]
            button = row.operator("object.fairing_inspect", text=label, depress=mode == current)
            button.mode = mode


_ENDS = {
    "MEAN": ("hollow", "bulging"),
    "GAUSS": ("saddle", "dome or bowl"),
    "TOTAL": ("calm", "bent"),
    "DEVIATION": ("inside", "outside"),
}


def _draw_legend(layout: bpy.types.UILayout, context: Context, target: Object, mode: str) -> None:
    limits = display.legend(target.data)
    if limits is None:
        draw_notice(layout, "Not measured yet: press Refresh Colours in Object Mode", icon="INFO")
    else:
        low, high = _ENDS[mode]
        colours = ("Grey", "red") if mode == "TOTAL" else ("Blue", "red")
        column = layout.column(align=True)
        texts = [display.value_text(context.scene, mode, limit) for limit in limits]
        column.label(text=f"{colours[0]}: {low}, {texts[0]}", icon="COLOR")
        column.label(text=f"{colours[1].title()}: {high}, {texts[1]}", icon="BLANK1")
        if display.shows_uncovered(target.data):
            column.label(text="Grey: no points of the scan", icon="BLANK1")
    layout.operator("object.fairing_refresh", icon="FILE_REFRESH")


class VIEW3D_PT_fairing_strain(Folded, bpy.types.Panel):
    bl_label = "Strain"

    def draw(self, context: Context) -> None:
        layout = split(self.layout)
        source = active_source(context)
        if source is None:
            layout.operator("object.fairing_strain")
            return
        layout.prop(source.discrete_fairing_strain, "show")
        strained = cache.found_of(source)
        if source.discrete_fairing_strain.show:
            layout.prop(context.scene.discrete_fairing_strain, "needle_length")
            layout.prop(context.scene.discrete_fairing_strain, "label_count")
        if cache.trouble(source):
            draw_notice(layout, cache.trouble(source))
        elif source.discrete_fairing_strain.show and cache.is_behind(source):
            layout.label(text="Measuring …", icon="SORTTIME")
        if strained is not None:
            _draw_worst(layout, context, source, strained)
            if strained.knuckle:
                draw_notice(
                    layout, looks_like_knuckle(strained.knuckle, strained.names), "QUESTION"
                )
                layout.operator("object.fairing_crease_knuckle", icon="EDGESEL")
        layout.operator("object.fairing_select_strained", icon="RESTRICT_SELECT_OFF")
        edited = context.mode == "EDIT_MESH"
        layout.operator("object.fairing_ease_selected" if edited else "object.fairing_ease")
        layout.operator("object.fairing_strain_table", icon="FILE_TEXT")


def _draw_worst(layout: Any, context: Context, source: Object, strained: Strained) -> None:
    text = Units.of(context.scene).lengths(max(strained.largest, strained.floor))
    drawing = context.scene.discrete_fairing_strain
    if not len(strained.held):
        draw_notice(
            layout,
            "No vertex can be released: all are corners, or lie on straight borders",
            icon="INFO",
        )
        return
    times = magnification(strained, drawing.needle_length)
    column = layout.column(align=True)
    column.label(text=f"Outliers: {len(strained.wrong)} of {len(strained.held):,}")
    column.label(text=f"Up to {text(strained.floor)} is scatter")
    if source.discrete_fairing_strain.show and times > 1.0:
        column.label(text=f"Lines are {times:g} times as long")
    column, wrong = layout.box().column(align=True), set(strained.wrong.tolist())
    for index in strained.worst(drawing.label_count).tolist():
        size = float(strained.lengths[index])
        row = column.row(align=True)
        row.active = index in wrong
        row.operator("object.fairing_go_to_strained", text=_name(strained, index)).vertex = index
        row.label(text=f"{text(abs(size))} {'outwards' if size > 0 else 'inwards'}")


def _name(strained: Strained, index: int) -> str:
    name = strained.name(index)
    return name[0].upper() + name[1:]


class VIEW3D_PT_fairing_hull(Folded, bpy.types.Panel):
    bl_label = "Hull"

    def draw(self, _context: Context) -> None:
        layout: Any = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator("import_mesh.fairing_offsets", icon="IMPORT")
        layout.operator("object.fairing_section_curves")
        layout.operator("export_scene.fairing_lines", icon="EXPORT")
        layout.operator("object.fairing_close")
        layout.operator("object.fairing_hydrostatics")
        layout.operator("object.fairing_hydrostatics_table", icon="FILE_TEXT")


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
        more = "" if len(holes) < MOST_HOLES else "at least "
        column.label(text=f"and {more}{len(holes) - _SHOWN} smaller ones")
