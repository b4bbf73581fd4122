# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of what surfaces are for."""

from typing import Any

import bpy
import bpy.utils.previews

from ..purposes import FOLDER, PURPOSES, preset_file, stem

# of a picture, in heights of a line
_SCALE = 4.5

_loaded: Any = None


def icon(purpose: str) -> int:
    """The number of a purpose's picture, for Blender's layouts."""
    return _loaded[stem(purpose)].icon_id


def draw_pictures(layout: bpy.types.UILayout) -> None:
    """Those with settings, two in a row."""
    grid = layout.grid_flow(row_major=True, columns=2, even_columns=True)
    for purpose, label, *_ in PURPOSES:
        path = preset_file(purpose)
        if path is None:
            continue
        column = grid.column(align=True)
        column.template_icon(icon_value=icon(purpose), scale=_SCALE)
        button: Any = column.operator("object.fairing_preset_apply", text=label)
        button.filepath = str(path)


def register() -> None:
    global _loaded
    _loaded = bpy.utils.previews.new()
    for purpose, *_ in PURPOSES:
        name = stem(purpose)
        _loaded.load(name, str(FOLDER / "pictures" / f"{name}.png"), "IMAGE")


def unregister() -> None:
    global _loaded
    bpy.utils.previews.remove(_loaded)
    _loaded = None
