# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an object shows its strain; and, for the whole scene, how it is drawn."""

from typing import Any

import bpy

from ..blender import Context
from ..fields import number, switch, whole
from ..inspection import overlay
from . import cache


def _show_changed(_group: Any, _context: Context) -> None:
    cache.shown_changed()
    overlay.redraw()


class FAIRING_PG_strain(bpy.types.PropertyGroup):
    """Stored with the object."""

    show: switch(
        "Show Strain",
        "Draws a line at each vertex: how far the surface would move there if this vertex were released",
        update=_show_changed,
        options=set(),
    )


class FAIRING_PG_strain_drawing(bpy.types.PropertyGroup):
    """Stored with the scene."""

    needle_length: number(
        "Longest Line",
        "Length at which the longest line is drawn, in mean edges of the mesh",
        1.0,
        min=0.0,
        soft_max=5.0,
        update=lambda _group, _context: overlay.redraw(),
    )
    label_count: whole(
        "Labels",
        "How many of the worst vertices have a label and are listed",
        10,
        min=0,
        max=1000,
        soft_max=30,
        update=lambda _group, _context: overlay.redraw(),
    )


ATTACHED = (
    (bpy.types.Object, "discrete_fairing_strain", FAIRING_PG_strain),
    (bpy.types.Scene, "discrete_fairing_strain", FAIRING_PG_strain_drawing),
)
