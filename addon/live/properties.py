# SPDX-License-Identifier: GPL-3.0-or-later
"""Live on the faired object: `object.discrete_fairing_live`."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import registry, switch
from .status import lines, problem

DEFAULT_LEVELS = 3


def _is_on(group):
    return switch.is_on(group.id_data)


def _switch(group, value):
    if value:
        switch.switch_on(group.id_data)
    else:
        switch.switch_off(group.id_data, bpy.context)


def _status(group):
    said = problem(group.id_data)
    return "\n".join([*lines(group.id_data), *([said] if said else [])])


def _milliseconds(group):
    session = registry.session_of(group.id_data)
    return sum(session.parts.values()) if session is not None else 0.0


class DISCRETE_FAIRING_PG_live(bpy.types.PropertyGroup):
    """How a faired object follows its source. Only `levels` is kept in files."""

    on: BoolProperty(
        name="Live",
        description="The surface follows while its source is edited. Off again after loading a file",
        get=_is_on,
        set=_switch,
    )
    levels: IntProperty(
        name="Live Levels",
        description="The level shown during an edit, at most the surface's own. The full level comes when the edit pauses. "
        "Lowered by itself where updates would be slow",
        default=DEFAULT_LEVELS,
        min=1,
        max=10,
        soft_max=5,
    )
    status: StringProperty(name="Status", description="What Live is doing, or why it has ended", get=_status)
    milliseconds: FloatProperty(
        name="Last Update", description="How long the last update took, in milliseconds", get=_milliseconds
    )


def register():
    bpy.utils.register_class(DISCRETE_FAIRING_PG_live)
    bpy.types.Object.discrete_fairing_live = PointerProperty(type=DISCRETE_FAIRING_PG_live)


def unregister():
    del bpy.types.Object.discrete_fairing_live
    bpy.utils.unregister_class(DISCRETE_FAIRING_PG_live)
