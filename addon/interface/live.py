# SPDX-License-Identifier: GPL-3.0-or-later
"""The switch Live with what it says, in the panel Fair Surface."""

from ..live import switch
from ..live.operator import OBJECT_OT_fair_live
from ..live.status import lines, problem
from .notice import draw_notice


def draw_live(layout, context):
    """For the active object: a faired surface, or a mesh whose surfaces are live or will be."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return
    is_surface = active.discrete_fairing.source is not None
    # one whose source is gone has still to say so
    targets = [active] if is_surface or problem(active) else switch.live_surfaces_of(active)
    on = any(map(switch.is_on, targets))
    row = layout.row()
    row.operator(OBJECT_OT_fair_live.bl_idname, icon="REC" if on else "RADIOBUT_OFF", depress=on)
    for target in targets:
        _draw_target(layout, target)


def _draw_target(layout, target):
    layout.prop(target.discrete_fairing_live, "levels")
    column = layout.column(align=True)
    for line in lines(target):
        column.label(text=line)
    if problem(target):
        draw_notice(layout, problem(target))
