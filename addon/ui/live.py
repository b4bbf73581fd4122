# SPDX-License-Identifier: GPL-3.0-or-later
"""The switch Live with what it says, in the panel Fair Surface."""

import bpy

from ..blender import Context, Object
from ..live import switch
from .notice import draw_notice


def draw_live(layout: bpy.types.UILayout, context: Context) -> None:
    """For the active object: a faired surface, or a mesh whose surfaces are live or will be."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return
    is_surface = active.discrete_fairing.source is not None
    # one whose source is gone has still to say so
    targets = [active] if is_surface or switch.problem(active) else switch.live_surfaces_of(active)
    on = any(map(switch.is_on, targets))
    row = layout.row()
    row.operator("object.fairing_live", icon="REC" if on else "RADIOBUT_OFF", depress=on)
    for target in targets:
        _draw_target(layout, target)


def _draw_target(layout: bpy.types.UILayout, target: Object) -> None:
    layout.prop(target.discrete_fairing_live, "levels")
    column = layout.column(align=True)
    for line in switch.lines(target):
        column.label(text=line)
    if switch.problem(target):
        draw_notice(layout, switch.problem(target))
