# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of jobs and options, drawn by examples/render_panel_pictures.py."""

from pathlib import Path
from typing import Any

import bpy
import bpy.utils.previews

from ..purposes import FOLDER, PURPOSES, preset_file, stem

PRESETS = FOLDER / "pictures"
SETTINGS = Path(__file__).resolve().parent / "setting_pictures"
# size of a picture, in heights of a line
_LARGE, _SMALL = 4.5, 2.6

_loaded: Any = None


def icon(key: str) -> int:
    """The icon of a job or an option, for Blender's layouts; 0 if it is missing."""
    picture = _loaded.get(stem(key)) if _loaded is not None else None
    return picture.icon_id if picture is not None else 0


def name_of(owner: Any, name: str) -> str:
    """The setting's name; the `bl_rna` of an operator that is drawn does not have it."""
    return owner.rna_type.properties[name].name


def _short(label: str) -> str:
    """A name without its part in brackets, for a button under a picture."""
    return label.partition(" (")[0]


def draw_pictures(layout: bpy.types.UILayout) -> None:
    """The jobs with settings, two in a row."""
    grid = layout.grid_flow(row_major=True, columns=2, even_columns=True)
    for purpose, label, *_ in PURPOSES:
        path = preset_file(purpose)
        if path is None:
            continue
        column = grid.column(align=True)
        column.template_icon(icon_value=icon(purpose), scale=_LARGE)
        button: Any = column.operator("object.fairing_preset_apply", text=_short(label))
        button.filepath = str(path)


def draw_purposes(layout: bpy.types.UILayout) -> None:
    """All jobs, three in a row: a click fairs. The last row's names are longer."""
    whole = len(PURPOSES) // 3 * 3
    grid = layout.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
    last = layout.row(align=True)
    for k, (purpose, label, *_) in enumerate(PURPOSES):
        column = (grid if k < whole else last).column(align=True)
        column.template_icon(icon_value=icon(purpose), scale=_SMALL)
        button: Any = column.operator("object.fairing_for", text=_short(label))
        button.purpose = purpose


def draw_choices(layout: bpy.types.UILayout, owner: Any, name: str, labels: dict[str, str]) -> None:
    """The options of a setting side by side, each under its picture; `labels`: short names. Auto is one of the others,
    so it stands beside the heading, without a picture: a sidebar of usual width has room for four.
    """
    heading, row = layout.row(), layout.row(align=True)
    heading.label(text=name_of(owner, name))
    heading.use_property_split = row.use_property_split = False
    pictured = dict(labels)
    if automatic := pictured.pop("AUTO", ""):
        heading.prop_enum(owner, name, "AUTO", text=automatic)
    for key, label in pictured.items():
        column = row.column(align=True)
        column.template_icon(icon_value=icon(key), scale=_SMALL)
        column.prop_enum(owner, name, key, text=label)


def draw_ends(layout: bpy.types.UILayout, low: str, high: str) -> None:
    row = layout.row()
    for key, text in ((low, "0"), (high, "1")):
        column = row.column()
        column.template_icon(icon_value=icon(key), scale=_SMALL)
        label = column.row()
        label.alignment = "CENTER"
        label.label(text=text)


def register() -> None:
    global _loaded
    _loaded = bpy.utils.previews.new()
    for path in (*PRESETS.glob("*.png"), *SETTINGS.glob("*.png")):
        _loaded.load(path.stem, str(path), "IMAGE")


def unregister() -> None:
    global _loaded
    bpy.utils.previews.remove(_loaded)
    _loaded = None
