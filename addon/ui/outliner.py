# SPDX-License-Identifier: GPL-3.0-or-later
"""The number of outdated surfaces in the Outliner's header; Python cannot draw in its rows."""

from typing import Any

import bpy

from ..blender import Context
from ..freshness import stale_surfaces
from ..live import switch


def draw_count(header: Any, _context: Context) -> None:
    count = sum(not switch.is_seen_to(target) for target in stale_surfaces())
    if count:
        # first and short, since the header is narrow
        header.layout.operator("object.fairing_recompute_stale", text=str(count), icon="ERROR")


def register() -> None:
    bpy.types.OUTLINER_HT_header.prepend(draw_count)


def unregister() -> None:
    bpy.types.OUTLINER_HT_header.remove(draw_count)
