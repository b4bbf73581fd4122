# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures to choose a shipped preset by."""

from pathlib import Path
from typing import Any

import bpy
import bpy.utils.previews

PRESETS = Path(__file__).resolve().parent.parent / "presets"
# file: what stands under its picture
SHOWN = {
    "Organic": "Organic",
    "Hull": "Hull",
    "Mechanical_with_Creases": "Mechanical",
    "Scan": "Scan",
}
_SCALE = 4.5  # of a picture, in heights of a line

_loaded: Any = None


def draw_pictures(layout: bpy.types.UILayout, folder: str) -> None:
    """Two in a row; `folder`: where the presets lie, below the one for all presets."""
    grid = layout.grid_flow(row_major=True, columns=2, even_columns=True)
    for stem, label in SHOWN.items():
        column = grid.column(align=True)
        column.template_icon(icon_value=_loaded[stem].icon_id, scale=_SCALE)
        button: Any = column.operator("object.fairing_preset_apply", text=label)
        button.filepath = str(PRESETS / folder / f"{stem}.py")


def register() -> None:
    global _loaded
    _loaded = bpy.utils.previews.new()
    for stem in SHOWN:
        _loaded.load(stem, str(PRESETS / "pictures" / f"{stem}.png"), "IMAGE")


def unregister() -> None:
    global _loaded
    bpy.utils.previews.remove(_loaded)
    _loaded = None
