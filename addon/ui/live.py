# SPDX-License-Identifier: GPL-3.0-or-later
"""The switch Live with its state, in the panel Fair Surface."""

import bpy

from ..blender import Context, Object
from ..live import switch
from ..surfaces.freshness import stale_surfaces, why_stale
from .layout import draw_notice


def draw_live(layout: bpy.types.UILayout, context: Context) -> None:
    """For the active object: a faired surface, or a mesh whose surfaces are or become live."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return
    is_surface = active.discrete_fairing.source is not None
    # a surface whose source is gone must still say so
    targets = [active] if is_surface or switch.problem(active) else switch.live_surfaces_of(active)
    on = any(map(switch.is_on, targets))
    row = layout.row()
    row.operator("object.fairing_live", icon="REC" if on else "RADIOBUT_OFF", depress=on)
    for target in targets:
        _draw_target(layout, context, target)


def draw_stale(layout: bpy.types.UILayout, target: Object) -> None:
    reason = "" if switch.is_seen_to(target) else why_stale(target)
    if reason:
        row = layout.row()
        row.alert = True
        row.label(text=f"Out of date: {reason[0].lower()}{reason[1:]}", icon="ERROR")


def draw_stale_surfaces(layout: bpy.types.UILayout, source: Object | None) -> None:
    """The same for the surfaces of a source."""
    stale = (
        [] if source is None else [t for t in stale_surfaces(source) if not switch.is_seen_to(t)]
    )
    for target in stale:
        row = layout.row()
        row.alert = True
        row.label(text=f"{target.name} is out of date", icon="ERROR")
    if stale:
        layout.operator("object.fairing_recompute_stale", icon="FILE_REFRESH")


def _draw_target(layout: bpy.types.UILayout, context: Context, target: Object) -> None:
    live = target.discrete_fairing_live
    layout.prop(live, "levels")
    if live.on:
        switches = layout.column(align=True, heading="Options")
        for name in ("cage_as_wire", "in_renders"):
            switches.prop(live, name)
        render = context.scene.render
        if live.in_renders and not render.use_lock_interface:
            switches.prop(render, "use_lock_interface")
            draw_notice(layout, "Live in Renders needs Lock Interface")
    column = layout.column(align=True)
    for line in switch.lines(target):
        column.label(text=line)
    if switch.problem(target):
        draw_notice(layout, switch.problem(target))
