# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Fairing": the few controls first, the rest folded away."""

import bpy

from .. import native
from ..read.source import source_objects
from ..request import size
from ..run.modal import running, status_text
from ..run.operator import OBJECT_OT_fair_recompute, OBJECT_OT_fair_surface
from ..run.show_source import OBJECT_OT_fair_show_source
from ..settings.layout import draw_advanced, draw_creases, draw_result, draw_shape, draw_source
from ..settings.presets import draw_presets
from ..settings.properties import copy_settings
from .live import draw_live
from .notice import draw_notice


class Sidebar:
    """Mix-in of every panel in the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Fairing"


class VIEW3D_PT_fairing(Sidebar, bpy.types.Panel):
    bl_label = "Fair Surface"

    def draw_header_preset(self, context):
        if remembered(context) is None:
            draw_presets(self.layout)

    def draw(self, context):
        layout = _split(self.layout)
        if native.why_missing():
            draw_notice(layout, native.why_missing())
            return
        memory = remembered(context)
        if memory is not None:
            _draw_source(layout, memory)
        settings = settings_at_hand(context)
        sources = source_objects(context) if memory is None else [memory.source]
        triangles = sum(size.triangle_count(size.face_sizes(o.data), settings.levels) for o in sources)
        draw_shape(layout, settings, size.count_text(triangles) if triangles else "")
        if triangles >= size.LARGE:
            draw_notice(layout, size.why_too_large(triangles) or "A large result: this takes a while")
        if running():
            _draw_progress(layout, running())
        elif memory is not None:
            _draw_button(layout, OBJECT_OT_fair_recompute, "FILE_REFRESH")
        else:
            text = "Fair Selected Faces" if settings.use_selection else "Fair Surface"
            copy_settings(settings, _draw_button(layout, OBJECT_OT_fair_surface, "SURFACE_DATA", text))
        draw_live(layout, context)


def remembered(context):
    """What the active object remembers of its making; None if it is no faired surface, or its source is gone."""
    active = context.active_object
    if active is None or active.type != "MESH" or active.discrete_fairing.source is None:
        return None
    return active.discrete_fairing


def settings_at_hand(context):
    """Those of the faired surface that is active, else those for the next one."""
    return remembered(context) or context.scene.discrete_fairing


class _Folded(Sidebar):
    bl_parent_id = "VIEW3D_PT_fairing"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.draw_body(_split(self.layout), settings_at_hand(context))


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


def _split(layout):
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def _draw_source(layout, memory):
    """Whose surface this is, and the way to what controls it."""
    row = layout.row(align=True)
    row.prop(memory, "source")
    row.operator(OBJECT_OT_fair_show_source.bl_idname, text="", icon="RESTRICT_SELECT_OFF")


def _draw_button(layout, operator, icon, text=None):
    """The one large button; returns its operator's properties."""
    row = layout.row()
    row.scale_y = 1.5
    return row.operator(operator.bl_idname, text=text or operator.bl_label, icon=icon)


def _draw_progress(layout, queue):
    layout.progress(factor=queue.fraction, text=status_text(queue))
    layout.label(text="Cancel", icon="EVENT_ESC")


CLASSES = (
    VIEW3D_PT_fairing,
    VIEW3D_PT_fairing_source,
    VIEW3D_PT_fairing_creases,
    VIEW3D_PT_fairing_result,
    VIEW3D_PT_fairing_advanced,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
