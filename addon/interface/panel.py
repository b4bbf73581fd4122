# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Fairing": the few controls first, the rest folded away."""

import bpy

from .. import native
from ..read.source import source_objects
from ..request import size
from ..run.operator import OBJECT_OT_fair_surface
from ..settings.layout import draw_advanced, draw_creases, draw_shape
from ..settings.properties import copy_settings


class _Sidebar:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Fairing"

    def _prepare(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout, context.scene.discrete_fairing


class VIEW3D_PT_fairing(_Sidebar, bpy.types.Panel):
    bl_label = "Fair Surface"

    def draw(self, context):
        layout, settings = self._prepare(context)
        if native.why_missing():
            _notice(layout, native.why_missing())
            return
        triangles = sum(
            size.triangle_count(size.face_sizes(o.data), settings.levels) for o in source_objects(context)
        )
        draw_shape(layout, settings, size.count_text(triangles) if triangles else "")
        if triangles >= size.LARGE:
            _notice(layout, size.why_too_large(triangles) or "A large result: this takes a while")
        button = layout.row()
        button.scale_y = 1.5
        copy_settings(settings, button.operator(OBJECT_OT_fair_surface.bl_idname, icon="SURFACE_DATA"))


class VIEW3D_PT_fairing_creases(_Sidebar, bpy.types.Panel):
    bl_label = "Creases"
    bl_parent_id = "VIEW3D_PT_fairing"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        draw_creases(*self._prepare(context))


class VIEW3D_PT_fairing_advanced(_Sidebar, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "VIEW3D_PT_fairing"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        draw_advanced(*self._prepare(context))


def _notice(layout, text):
    """A sentence in a box, broken into lines: labels do not wrap."""
    box = layout.box().column(align=True)
    line = ""
    icon = "ERROR"
    for word in text.split():
        if line and len(line) + len(word) > 36:
            box.label(text=line, icon=icon)
            line, icon = "", "BLANK1"
        line = f"{line} {word}".strip()
    box.label(text=line, icon=icon)


CLASSES = (VIEW3D_PT_fairing, VIEW3D_PT_fairing_creases, VIEW3D_PT_fairing_advanced)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
