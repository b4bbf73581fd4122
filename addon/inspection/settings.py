# SPDX-License-Identifier: GPL-3.0-or-later
"""The display of each object; and settings of a scene, so that its objects are comparable."""

from collections.abc import Callable
from math import radians
from typing import Any

import bpy
from bpy.props import PointerProperty

from ..blender import Context, Mesh, Object, scene_of
from ..choices import SECTION_AXES, STRIPES_FIXED_TO
from ..fields import choice, factor, number, switch, whole
from . import display, overlay

# fmt: off
MODES = (
    ("NONE", "Off", "The object in its own materials", "SHADING_SOLID", 0),
    ("ZEBRA", "Zebra",
     "Stripes as if the surface mirrored light tubes: they break at edges, kink where curvature jumps, else "
     "flow", "ALIGN_JUSTIFY", 1),
    ("MEAN", "Mean",
     "Mean curvature: how much the surface bulges (red) or is hollow (blue), on average over all "
     "directions", "COLOR", 2),
    ("GAUSS", "Gauss",
     "Gaussian curvature: domes and bowls (red), saddles (blue), and what can be unrolled flat (white)", "COLOR", 3),
    ("TOTAL", "Total",
     "Total curvature: how strongly the surface bends, whichever way, with red where it is least fair", "COLOR", 4),
    ("LINES", "Lines",
     "Reflection lines: thin dark tubes in a light room, which show small faults between the stripes of "
     "Zebra", "ALIGN_FLUSH", 5),
    ("ISOPHOTES", "Isophotes",
     "Lines of equal brightness: they follow the direction of the surface alone, wherever you look "
     "from", "LIGHT_SUN", 6),
    ("DEVIATION", "Deviation",
     "How far the surface is from its scans, from the vertices of its source or from another object: outside (red), "
     "inside (blue); grey where a scan has no points", "DRIVER_DISTANCE", 7),
)
# fmt: on


def _mode_changed(group: Any, _context: Context) -> None:
    target = group.id_data
    if isinstance(target.data, Mesh):
        display.show(target, group.mode, scene_of(target).discrete_fairing_inspection)


def _for_all(act: Callable[[Object, Any], None]) -> Callable[[Any, Context], None]:
    """An update callback: `act` on all meshes of the scene; one in two scenes shows the last change."""

    def changed(group: Any, _context: Context) -> None:
        for target in group.id_data.objects:
            if target.type == "MESH":
                act(target, group)
        overlay.redraw()

    return changed


def _measure_deviation(target: Object, settings: Any) -> None:
    if target.discrete_fairing_inspection.mode == "DEVIATION":
        display.refresh(target, settings)


_drawing_changed, _range_changed = _for_all(display.redraw), _for_all(display.recolour)


class FAIRING_PG_display(bpy.types.PropertyGroup):
    """The display of an object; stored with the object."""

    mode: choice(
        "Show",
        "What the object shows instead of its materials",
        MODES,
        update=_mode_changed,
        options=set(),
    )
    sections: switch(
        "Sections",
        "Draws the curves in which even planes cut the object, in any shading",
        update=lambda _group, _context: overlay.shown_changed(),
        options=set(),
    )


class FAIRING_PG_inspection(bpy.types.PropertyGroup):
    """Settings of the display; stored with the scene."""

    key: whole(
        "Key", "Distinguishes the materials of this scene from those of others", options={"HIDDEN"}
    )

    stripes: whole(
        "Stripes",
        "Number of pairs of light and dark stripes: more stripes show smaller faults",
        10,
        min=1,
        max=200,
        soft_max=60,
        update=_drawing_changed,
    )
    direction: number(
        "Direction",
        "How far the stripes lean, from 0° level to 90° upright: faults show best in stripes that cross them",
        radians(20),
        soft_min=radians(-90),
        soft_max=radians(90),
        update=_drawing_changed,
        subtype="ANGLE",
    )
    sharpness: factor(
        "Sharpness",
        "Sharpness of the edges of the stripes: softer edges suit coarse meshes",
        0.95,
        update=_drawing_changed,
    )
    fixed_to: choice(
        "Fixed to",
        "Where the light tubes stand",
        STRIPES_FIXED_TO,
        update=_drawing_changed,
    )
    smooth: switch(
        "Smooth",
        "Shades the object smooth while it is inspected, except at edges marked sharp",
        True,
        update=_drawing_changed,
    )
    use_fixed_range: switch(
        "Fixed Range",
        "The same colours for the same curvature on every object, so that they can be compared",
        update=_range_changed,
    )
    fixed_range: number(
        "Limit",
        "The curvature that gets the last colour: one over a radius, or over a radius squared, "
        "in the object's own units",
        2.0,
        min=1e-6,
        soft_max=100.0,
        precision=3,
        update=_range_changed,
    )
    fixed_deviation: number(
        "Limit",
        "The distance that gets the last colour",
        0.01,
        min=1e-9,
        soft_max=1.0,
        precision=4,
        unit="LENGTH",
        update=_range_changed,
    )
    deviation_object: PointerProperty(
        name="Measured from",
        description="The mesh object from which distances are measured; if empty, the vertices of the source",
        type=bpy.types.Object,
        poll=lambda _group, target: target.type == "MESH",
        update=_for_all(_measure_deviation),
    )
    section_axes: choice(
        "Planes across",
        "The axes of the object across which the planes cut, several with Shift",
        SECTION_AXES,
        {"X"},
        options={"ENUM_FLAG"},
        update=lambda _group, _context: overlay.redraw(),
    )
    section_count: whole(
        "Planes",
        "How many planes cut the object across each axis",
        10,
        min=1,
        max=200,
        soft_max=50,
        update=lambda _group, _context: overlay.redraw(),
    )
    show_combs: switch(
        "Combs",
        "Draws curvature as teeth: an even comb is a fair curve, a notch a flat spot, a spike a tight bend",
        True,
        update=lambda _group, _context: overlay.redraw(),
    )
    comb_scale: number(
        "Comb Scale",
        "Scales the length of the teeth",
        1.0,
        min=0.0,
        soft_max=5.0,
        update=lambda _group, _context: overlay.redraw(),
    )


ATTACHED = (
    (bpy.types.Object, "discrete_fairing_inspection", FAIRING_PG_display),
    (bpy.types.Scene, "discrete_fairing_inspection", FAIRING_PG_inspection),
)
