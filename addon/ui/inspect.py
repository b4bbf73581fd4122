# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Inspect": stripes, colours, and sections."""

from typing import Any

import bpy

from ..blender import Context, Object
from ..inspection import display, viewport_shading
from ..inspection.display import VALUES
from ..inspection.materials import STRIPES
from ..inspection.settings import MODES
from .layout import Sidebar, draw_notice, split


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
