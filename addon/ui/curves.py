# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels for curves: the surface to make over selected ones, and the curves of a surface."""

from typing import cast

import bpy

from ..blender import Context, Object
from ..memory import source_of
from ..mesh.read_curves import has_curves
from ..surfaces import curve_cage
from ..surfaces.curve_cage import CageSettings
from .layout import Sidebar, draw_notice


class VIEW3D_PT_fairing_curves(Sidebar, bpy.types.Panel):
    bl_label = "Surface from Curves"

    @classmethod
    def poll(cls, context: Context) -> bool:
        active = context.active_object
        return active is not None and (has_curves(active) or _cage_of(active) is not None)

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        active = cast(Object, context.active_object)
        cage = _cage_of(active)
        if cage is None:
            layout.operator_context = "INVOKE_DEFAULT"
            layout.operator("object.fairing_curves", icon="SURFACE_DATA")
            layout.prop(active.discrete_fairing_curves, "sharp")
            return
        count = len(curve_cage.curves_of(cage))
        layout.label(text=f"Over {count} curve objects", icon="CURVE_DATA")
        for name in CageSettings.__annotations__:
            layout.prop(cage.discrete_fairing_curves, name)
        for sentence in curve_cage.remarks_of(cage):
            draw_notice(layout, sentence)


def _cage_of(active: Object) -> Object | None:
    """The control mesh over curves: `active` itself, or its source."""
    source = source_of(active) or active
    return source if curve_cage.is_cage(source) else None
