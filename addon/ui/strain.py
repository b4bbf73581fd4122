# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Strain": the control vertices that spoil the surface, and buttons that ease them."""

from typing import Any

import bpy

from ..blender import Context, Object
from ..memory import active_source
from ..strain import cache
from ..strain.drawn import magnification
from ..strain.strained import Strained
from ..strain.words import looks_like_knuckle
from ..units import Units
from .layout import Folded, draw_notice, split


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
