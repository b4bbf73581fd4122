# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Fairing": the few controls first, the rest folded away."""

import bpy

from .. import native
from ..read.source import source_objects
from ..request import size
from ..run.modal import running, status_text
from ..run.operator import OBJECT_OT_fair_recompute, OBJECT_OT_fair_surface
from ..settings.layout import draw_advanced, draw_creases, draw_result, draw_settings, draw_shape, draw_source
from ..settings.presets import draw_presets
from ..settings.properties import copy_settings
from .notice import draw_notice


class Sidebar:
    """Mix-in of every panel in the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Fairing"


class VIEW3D_PT_fairing(Sidebar, bpy.types.Panel):
    bl_label = "Fair Surface"

    def draw_header_preset(self, _context):
        draw_presets(self.layout)

    def draw(self, context):
        layout, settings = _split(self.layout), context.scene.discrete_fairing
        if native.why_missing():
            draw_notice(layout, native.why_missing())
            return
        triangles = sum(
            size.triangle_count(size.face_sizes(o.data), settings.levels) for o in source_objects(context)
        )
        draw_shape(layout, settings, size.count_text(triangles) if triangles else "")
        if triangles >= size.LARGE:
            draw_notice(layout, size.why_too_large(triangles) or "A large result: this takes a while")
        if running():
            _draw_progress(layout, running())
        else:
            _draw_buttons(layout, context, settings)


class _Folded(Sidebar):
    bl_parent_id = "VIEW3D_PT_fairing"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.draw_body(_split(self.layout), context.scene.discrete_fairing)


class VIEW3D_PT_fairing_source(_Folded, bpy.types.Panel):
    bl_label = "Source"
    draw_body = staticmethod(draw_source)


class VIEW3D_PT_fairing_creases(_Folded, bpy.types.Panel):
    bl_label = "Creases"
    draw_body = staticmethod(draw_creases)


class VIEW3D_PT_fairing_result(_Folded, bpy.types.Panel):
    bl_label = "Result"
    draw_body = staticmethod(draw_result)


class VIEW3D_PT_fairing_advanced(_Folded, bpy.types.Panel):
    bl_label = "Advanced"
    draw_body = staticmethod(draw_advanced)


class VIEW3D_PT_fairing_memory(Sidebar, bpy.types.Panel):
    """What the active object remembers of its making, to be changed and computed again"""

    bl_label = "This Surface"

    @classmethod
    def poll(cls, context):
        active = context.active_object
        return active is not None and active.type == "MESH" and "fairing_report" in active

    def draw(self, context):
        layout, memory = _split(self.layout), context.active_object.discrete_fairing
        if memory.source is None:
            draw_notice(layout, "Its source was deleted, so it cannot be computed again", icon="INFO")
            return
        layout.prop(memory, "source")
        draw_settings(layout, memory, "discrete_fairing.memory")
        layout.operator(OBJECT_OT_fair_recompute.bl_idname, icon="FILE_REFRESH")


def _split(layout):
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def _draw_buttons(layout, context, settings):
    button = layout.row()
    button.scale_y = 1.5
    text = "Fair Selected Faces" if settings.use_selection else "Fair Surface"
    copy_settings(settings, button.operator(OBJECT_OT_fair_surface.bl_idname, text=text, icon="SURFACE_DATA"))


def _draw_progress(layout, queue):
    layout.progress(factor=queue.fraction, text=status_text(queue))
    layout.label(text="ESC: Cancel", icon="EVENT_ESC")


CLASSES = (
    VIEW3D_PT_fairing,
    VIEW3D_PT_fairing_source,
    VIEW3D_PT_fairing_creases,
    VIEW3D_PT_fairing_result,
    VIEW3D_PT_fairing_advanced,
    VIEW3D_PT_fairing_memory,
)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
