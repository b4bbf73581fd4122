# SPDX-License-Identifier: GPL-3.0-or-later
"""The layout of settings, for sidebar, redo panel and stored surfaces."""

import textwrap
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import bpy

from ..choices import ENERGY_MEANINGS, ENERGY_NAMES, INTERPOLATION_NAMES
from ..curve_cage import HOLD
from ..properties import FairingSettings, FitAmount
from ..purposes import name_of_purpose
from ..settings import is_evaluated, is_limit, is_near
from .pictures import draw_choices, draw_ends, icon, name_of

WIDTH = 33  # characters that fit a sidebar of default width


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


def draw_notice(layout: bpy.types.UILayout, text: str, icon: Any = "ERROR") -> None:
    """Sentences, broken into lines, since Blender's labels do not wrap."""
    box = layout.box().column(align=True)
    for line in textwrap.wrap(text, WIDTH):
        box.label(text=line, icon=icon)
        icon = "BLANK1"


@dataclass(frozen=True)
class Known:
    """Remarks on the source, empty for none; below their setting, as the sidebar is narrow."""

    triangles: str = ""
    tolerance: str = ""  # the resulting length
    held: str = ""  # number of vertices at the tolerance
    missing_groups: dict[str, str] = field(default_factory=dict)
    edges: str = ""  # border edges with their own boundary
    normals: str = ""  # fixed normals
    flats: str = ""  # faces that stay flat
    vertices: str = ""  # the meaning of Auto
    follows: bool = False  # whether that is Limit


_NOTHING = Known()


def draw_job(
    layout: bpy.types.UILayout, settings: FairingSettings, known: Known = _NOTHING, job: str = ""
) -> None:
    """How fine, how near to the source; and energy and vertices unless a `job` sets them."""
    if job:
        layout.label(text=name_of_purpose(job), icon_value=icon(job))
    layout.prop(settings, "levels")
    if known.triangles:
        _remark(layout, known.triangles)
    if not job:
        draw_fairness(layout, settings, known)
    if is_limit(settings) or known.follows:
        layout.prop(settings, "limit", slider=True)
    elif is_near(settings):
        _draw_tolerance(layout, settings, known)


def amount_names(near: FitAmount) -> tuple[str, ...]:
    return ("amount", "tolerance") if near.amount == "TOLERANCE" else ("amount",)


def draw_fairness(
    layout: bpy.types.UILayout, settings: FairingSettings, known: Known = _NOTHING
) -> None:
    """The settings that a job sets: the energy and the meaning of vertices."""
    draw_choices(layout, settings, "energy", ENERGY_NAMES)
    _remark(layout, ENERGY_MEANINGS[settings.energy])
    draw_choices(layout, settings, "interpolation", INTERPOLATION_NAMES)
    if known.vertices:
        _remark(layout, known.vertices)


def draw_shape(
    layout: bpy.types.UILayout, settings: FairingSettings, known: Known = _NOTHING
) -> None:
    if is_near(settings):
        _draw_held_by(layout, settings, known)
    _draw_pads(layout, settings)
    row = layout.row()
    row.active = settings.energy != "MINIMUM_VARIATION"
    row.prop(settings, "tension")
    if not row.active:
        _reason(layout, "Not with this fairness")
    layout.prop(settings, "boundary")
    if known.edges:
        _remark(layout, known.edges)
    layout.prop(settings, "symmetry_plane")
    if known.normals:
        _remark(layout, known.normals)
    if known.flats:
        _remark(layout, known.flats)


def _draw_tolerance(layout: bpy.types.UILayout, settings: FairingSettings, known: Known) -> None:
    if settings.pull_group == HOLD:  # a surface from curves, for which a length is meaningless
        _remark(layout, "Held along its curves")
        return
    layout.prop(settings, "tolerance", text="Hold within")
    if known.tolerance:
        _remark(layout, known.tolerance)
    if known.held:
        _remark(layout, known.held)


def _draw_held_by(layout: bpy.types.UILayout, settings: FairingSettings, known: Known) -> None:
    """The unit of the tolerance, and its value at each vertex."""
    layout.prop(settings, "tolerance_unit")
    for name in ("tolerance_group", "pull_group"):
        missing = known.missing_groups.get(name, "")
        row = layout.row()
        row.alert = bool(missing)
        row.prop(settings, name, icon="GROUP_VERTEX")
        if missing:
            _remark(layout, missing, icon="ERROR")


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
    layout.use_property_split = True
    layout.use_property_decorate = False
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
