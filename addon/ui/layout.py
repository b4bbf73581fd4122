# SPDX-License-Identifier: GPL-3.0-or-later
"""The layout of settings, for sidebar, redo panel and stored surfaces."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import bpy

from ..choices import ENERGY_MEANINGS, ENERGY_NAMES, INTERPOLATION_NAMES
from ..properties import FairingSettings, FitAmount
from ..purposes import name_of_purpose
from ..settings import is_evaluated, is_limit, is_near
from ..surfaces.curve_cage import HOLD
from .pictures import draw_choices, draw_ends, icon, name_of

WIDTH = 33  # characters that fit a sidebar of default width
# what is known about the source, by the setting below which it stands, since the sidebar is narrow
Remarks: TypeAlias = Mapping[str, Sequence[str]]


class Sidebar:
    """Mix-in of every panel in the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Fairing"

    if TYPE_CHECKING:
        layout: bpy.types.UILayout


class Folded(Sidebar):
    """Mix-in of the panels below Inspect."""

    bl_parent_id = "VIEW3D_PT_fairing_inspect"
    bl_options = {"DEFAULT_CLOSED"}


def split(layout: Any) -> Any:
    """The layout with the names of properties in a column of their own."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def draw_notice(layout: bpy.types.UILayout, text: str, icon: Any = "ERROR") -> None:
    """Sentences, broken into lines, since Blender's labels do not wrap."""
    box = layout.box().column(align=True)
    for line in textwrap.wrap(text, WIDTH):
        box.label(text=line, icon=icon)
        icon = "BLANK1"


_NOTHING: Remarks = {}


def draw_job(
    layout: bpy.types.UILayout,
    settings: FairingSettings,
    remarks: Remarks = _NOTHING,
    job: str = "",
    follows: bool = False,
) -> None:
    """How fine, how near to the source; and energy and vertices unless a `job` sets them. `follows`: whether
    Auto is Limit.
    """
    if job:
        layout.label(text=name_of_purpose(job), icon_value=icon(job))
    layout.prop(settings, "levels")
    _draw_remarks(layout, remarks, "levels")
    if not job:
        draw_fairness(layout, settings, remarks)
    if is_limit(settings) or follows:
        layout.prop(settings, "limit", slider=True)
    elif is_near(settings) and settings.pull_group == HOLD:  # a length is meaningless
        _remark(layout, "Held along its curves")
    elif is_near(settings):
        layout.prop(settings, "tolerance", text="Hold within")
        _draw_remarks(layout, remarks, "tolerance")


def amount_names(near: FitAmount) -> tuple[str, ...]:
    return ("amount", "tolerance") if near.amount == "TOLERANCE" else ("amount",)


def draw_fairness(
    layout: bpy.types.UILayout, settings: FairingSettings, remarks: Remarks = _NOTHING
) -> None:
    """The settings that a job sets: the energy and the meaning of vertices."""
    draw_choices(layout, settings, "energy", ENERGY_NAMES)
    _remark(layout, ENERGY_MEANINGS[settings.energy])
    draw_choices(layout, settings, "interpolation", INTERPOLATION_NAMES)
    _draw_remarks(layout, remarks, "interpolation")


def draw_shape(
    layout: bpy.types.UILayout, settings: FairingSettings, remarks: Remarks = _NOTHING
) -> None:
    if is_near(settings):
        layout.prop(settings, "tolerance_unit")
        for name in ("tolerance_group", "pull_group"):
            row = layout.row()
            row.alert = name in remarks
            row.prop(settings, name, icon="GROUP_VERTEX")
            _draw_remarks(layout, remarks, name, icon="ERROR")
    _draw_pads(layout, settings)
    row = layout.row()
    row.active = settings.energy != "MINIMUM_VARIATION"
    row.prop(settings, "tension")
    if not row.active:
        _reason(layout, "Not with this fairness")
    for name in ("boundary", "symmetry_plane"):
        layout.prop(settings, name)
        _draw_remarks(layout, remarks, name)


def _draw_pads(layout: bpy.types.UILayout, settings: FairingSettings) -> None:
    start_only = settings.energy == "MINIMUM_VARIATION"
    row = layout.row()
    row.active = not start_only
    row.prop(settings, "pad_size")
    if start_only:
        _reason(layout, "Used for the start only")
    else:
        draw_ends(layout, settings.energy, f"{settings.energy}_SOFTLY")


def draw_source(layout: bpy.types.UILayout, settings: FairingSettings) -> None:
    layout.prop(settings, "use_selection")
    if settings.use_selection:
        layout.prop(settings, "joint")
    row = layout.row()
    row.enabled = not settings.use_selection
    row.prop(settings, "mesh_source")
    if settings.use_selection:
        _reason(layout, "Faces are selected on the mesh as modelled")
    layout.prop(settings, "repair")
    if settings.repair == "MEND":
        layout.prop(settings, "weld")


def draw_creases(layout: bpy.types.UILayout, settings: FairingSettings) -> None:
    _switched(layout, settings, "use_crease_attribute", "crease_threshold")
    layout.prop(settings, "use_sharp_edges")
    _switched(layout, settings, "use_crease_angle", "crease_angle")
    _switched(layout, settings, "use_corner_angle", "corner_angle")


def draw_result(layout: bpy.types.UILayout, settings: FairingSettings) -> None:
    layout.prop(settings, "shade_smooth")
    layout.prop(settings, "hide_source")
    evaluated = is_evaluated(settings)
    column = layout.column()
    column.enabled = not evaluated
    column.prop(settings, "use_shape_keys")
    column.prop(settings, "copy_modifiers")
    if evaluated:
        _reason(layout, "Both are already in the mesh With Modifiers")


def draw_advanced(layout: bpy.types.UILayout, settings: FairingSettings) -> None:
    layout.prop(settings, "metric_exponent")


FOLDED = (
    ("Source", draw_source),
    ("Creases", draw_creases),
    ("Result", draw_result),
    ("Advanced", draw_advanced),
)


def draw_settings(layout: bpy.types.UILayout, settings: FairingSettings, identifier: str) -> None:
    """All settings, the rare ones folded; Blender stores under `identifier` which are open."""
    split(layout)
    draw_job(layout, settings)
    draw_shape(layout, settings)
    draw_folded(layout, settings, identifier)


def draw_folded(layout: bpy.types.UILayout, settings: FairingSettings, identifier: str) -> None:
    for label, draw in FOLDED:
        header, body = layout.panel(f"{identifier}.{label}", default_closed=True)
        header.label(text=label)
        if body is not None:
            draw(body, settings)


def _reason(layout: bpy.types.UILayout, text: str) -> None:
    """Why the setting above is grey."""
    _remark(layout, text, icon="INFO")


def _draw_remarks(
    layout: bpy.types.UILayout, remarks: Remarks, setting: str, icon: Any = "NONE"
) -> None:
    for text in filter(None, remarks.get(setting, ())):
        _remark(layout, text, icon)


def _remark(layout: bpy.types.UILayout, text: str, icon: Any = "NONE") -> None:
    """A few words on the setting above."""
    row = layout.row()
    row.alignment = "RIGHT"
    row.label(text=text, icon=icon)


def _switched(layout: bpy.types.UILayout, settings: Any, switch: str, value: str) -> None:
    """A value with a switch in front, grey while that is off."""
    row = layout.row(align=True, heading=name_of(settings, switch))
    row.prop(settings, switch, text="")
    sub = row.row(align=True)
    sub.active = getattr(settings, switch)
    sub.prop(settings, value, text="")
