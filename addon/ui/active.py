# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel is about: a surface, the one that follows the active object, or the next one."""

from typing import Any, cast

import bpy

from ..blender import Context, Object
from ..live.switch import live_surfaces_of
from ..memory import FAIRING_PG_fit, FAIRING_PG_surface, source_of
from ..mesh.read import control_meshes
from ..properties import FairingSettings


def remembered(context: Context) -> FAIRING_PG_surface | None:
    """The stored settings of the active object; None if it is no faired surface, or its source is gone."""
    active = context.active_object
    if active is None or active.type != "MESH" or active.discrete_fairing.source is None:
        return None
    return active.discrete_fairing


def near_scans(context: Context) -> FAIRING_PG_fit | None:
    """The stored fit of the active surface; None for other surfaces."""
    near = cast(Object, context.active_object).discrete_fairing_fit
    return near if len(near.scans) else None


def live_surface(context: Context) -> Object | None:
    """The surface that follows the active object; None if there is none."""
    active = context.active_object
    followers = live_surfaces_of(active) if active is not None else []
    return followers[0] if followers else None


def active_settings(context: Context) -> FairingSettings:
    """Settings of the active surface, or the live one of its source; else of the next one."""
    followed = live_surface(context)
    return (
        remembered(context)
        or (followed.discrete_fairing if followed is not None else None)
        or context.scene.discrete_fairing
    )


def fairing_operator(context: Context) -> Any:
    """The operator of the button: Recompute for a stored surface, else Fair Surface."""
    operators: Any = bpy.ops.object
    again = remembered(context) is not None
    return operators.fairing_recompute if again else operators.fairing_surface


def sources_of(context: Context, memory: FAIRING_PG_surface | None) -> list[Object]:
    """The sources of the surface with the panel's settings."""
    if memory is None:
        return control_meshes(context)
    source = source_of(cast(Object, memory.id_data))
    return [] if source is None else [source]
