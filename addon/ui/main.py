# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Fairing": the few controls first, the rest folded away."""

from collections.abc import Callable
from typing import Any

import bpy
from bl_ui.utils import PresetPanel

from .. import core, size, vertex_values
from ..blender import Context, Object, registration
from ..core import mean_edge_length, tolerance
from ..errors import repairs_text
from ..memory import FAIRING_PG_surface, recall
from ..mesh.read import read_mesh, source_objects
from ..queue import Queue, running, status_text
from ..settings import Settings, copy_settings, is_evaluated, is_near
from .layout import (
    Folded,
    Sidebar,
    draw_advanced,
    draw_creases,
    draw_result,
    draw_shape,
    draw_source,
)
from .live import draw_live
from .notice import draw_notice

# where Blender looks for the presets of the operator, which are those of the panel
PRESET_FOLDER = "operator/object.fair_surface"
_MEASURED_WHILE_DRAWING = 100_000  # edges: a few milliseconds


class VIEW3D_PT_fairing_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Fairing Presets"
    preset_subdir = PRESET_FOLDER
    preset_operator = "object.fairing_preset_apply"
    preset_add_operator = "object.fairing_preset_add"


class VIEW3D_PT_fairing(Sidebar, bpy.types.Panel):
    bl_label = "Fair Surface"

    def draw_header_preset(self, context: Context) -> None:
        if remembered(context) is None:
            VIEW3D_PT_fairing_presets.draw_panel_header(self.layout)

    def draw(self, context: Context) -> None:
        layout = _split(self.layout)
        if core.why_missing():
            draw_notice(layout, core.why_missing())
            return
        memory = remembered(context)
        if memory is not None:
            _draw_source(layout, memory)
            _draw_repairs(layout, context.active_object)
        settings = settings_at_hand(context)
        sources = source_objects(context) if memory is None else [memory.source]
        triangles = sum(
            size.triangle_count(size.face_sizes(o.data), settings.levels) for o in sources
        )
        draw_shape(
            layout,
            settings,
            size.count_text(triangles) if triangles else "",
            tolerance_text(context, settings, sources),
            missing_group(settings, sources),
        )
        if triangles >= size.LARGE:
            draw_notice(
                layout, size.why_too_large(triangles) or "A large result: this takes a while"
            )
        queue = running()
        if queue is not None:
            _draw_progress(layout, queue)
        elif memory is not None:
            _draw_button(layout, "object.fairing_recompute", "FILE_REFRESH", "Recompute")
        else:
            text = "Fair Selected Faces" if settings.use_selection else "Fair Surface"
            copy_settings(
                settings, _draw_button(layout, "object.fair_surface", "SURFACE_DATA", text)
            )
        draw_live(layout, context)


def remembered(context: Context) -> FAIRING_PG_surface | None:
    """What the active object remembers of its making; None if it is no faired surface, or its
    source is gone.
    """
    active = context.active_object
    if active is None or active.type != "MESH" or active.discrete_fairing.source is None:
        return None
    return active.discrete_fairing


def settings_at_hand(context: Context) -> Settings:
    """Those of the faired surface that is active, else those for the next one."""
    return remembered(context) or context.scene.discrete_fairing


def tolerance_text(context: Context, settings: Settings, sources: list[Object]) -> str:
    """The length that a relative tolerance comes to; empty where it would not be the one that
    counts, or takes long to find out.
    """
    if not is_near(settings) or is_evaluated(settings) or len(sources) != 1:
        return ""
    mesh = sources[0].data
    if len(mesh.edges) > _MEASURED_WHILE_DRAWING or sources[0].mode == "EDIT":
        return ""
    length = tolerance(settings, mean_edge_length(read_mesh(mesh)))
    units = context.scene.unit_settings
    if units.system == "NONE":  # of which Blender's own function makes a crash
        return f"= {length:.4g}"
    return "= " + bpy.utils.units.to_string(
        units.system, "LENGTH", length * units.scale_length, precision=4
    )


def missing_group(settings: Settings, sources: list[Object]) -> str:
    """Which source lacks the tolerance group, in a few words; empty if none, or if modifiers may
    make it.
    """
    name = settings.tolerance_group
    if not name or is_evaluated(settings):
        return ""
    lacking = [o.name for o in sources if not vertex_values.exists(o, o.data, name)]
    return f"Not in {lacking[0]}" if lacking else ""


class _FoldedSettings(Folded):
    draw_body: Callable[[bpy.types.UILayout, Settings], None]

    def draw(self, context: Context) -> None:
        self.draw_body(_split(self.layout), settings_at_hand(context))


class VIEW3D_PT_fairing_source(_FoldedSettings, bpy.types.Panel):
    bl_label = "Source"
    draw_body = staticmethod(draw_source)


class VIEW3D_PT_fairing_creases(_FoldedSettings, bpy.types.Panel):
    bl_label = "Creases"
    draw_body = staticmethod(draw_creases)


class VIEW3D_PT_fairing_result(_FoldedSettings, bpy.types.Panel):
    bl_label = "Result"
    draw_body = staticmethod(draw_result)


class VIEW3D_PT_fairing_advanced(_FoldedSettings, bpy.types.Panel):
    bl_label = "Advanced"
    draw_body = staticmethod(draw_advanced)


def _split(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def _draw_source(layout: bpy.types.UILayout, memory: FAIRING_PG_surface) -> None:
    """Whose surface this is, and the way to what controls it."""
    row = layout.row(align=True)
    row.prop(memory, "source")
    row.operator("object.fairing_show_source", text="", icon="RESTRICT_SELECT_OFF")


def _draw_repairs(layout: bpy.types.UILayout, surface: Object | None) -> None:
    """What was mended of the source when this surface was made."""
    report = (recall(surface, "report") if surface else None) or {}
    mended = repairs_text(report.get("repairs", ()))
    if mended:
        draw_notice(layout, mended, icon="INFO")


def _draw_button(layout: bpy.types.UILayout, operator: str, icon: Any, text: str) -> Any:
    """The one large button; returns its operator's properties."""
    row = layout.row()
    row.scale_y = 1.5
    return row.operator(operator, text=text, icon=icon)


def _draw_progress(layout: bpy.types.UILayout, queue: Queue) -> None:
    layout.progress(factor=queue.fraction, text=status_text(queue))
    layout.label(text="Cancel", icon="EVENT_ESC")


CLASSES = (
    VIEW3D_PT_fairing_presets,
    VIEW3D_PT_fairing,
    VIEW3D_PT_fairing_source,
    VIEW3D_PT_fairing_creases,
    VIEW3D_PT_fairing_result,
    VIEW3D_PT_fairing_advanced,
)

register, unregister = registration(*CLASSES)
