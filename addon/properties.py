# SPDX-License-Identifier: GPL-3.0-or-later
"""Every setting once, as Blender's property, for operator, panel, command line and stored surfaces.

A new setting is added here, to `Settings` (settings.py), core.fair_arguments and ui/layout.py; the
command line follows by itself.
"""

from math import radians
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from . import vertex_values
from .blender import Context, Object
from .choices import (
    BOUNDARIES,
    DEFAULT_ENERGY,
    ENERGIES,
    ENERGY_MEANING,
    INTERPOLATIONS,
    JOINTS,
    MESH_SOURCES,
    REPAIRS,
    SYMMETRY_PLANES,
    TOLERANCE_UNITS,
)
from .settings import NAMES, OF_NEAR, Settings


def _vertex_values(settings: Any, context: Context, _typed: str) -> list[tuple[str, str]]:
    """Suggestions for the name of a vertex group: (name, kind)."""
    offered = dict(
        pair for source in _sources(settings, context) for pair in vertex_values.names(source)
    )
    return sorted(offered.items())


def _sources(settings: Any, context: Context) -> list[Object]:
    """The objects whose groups are named: the surface's source, else the selected meshes."""
    active = context.active_object
    owner = getattr(settings, "source", None)
    if owner is None and active is not None and active.type == "MESH":
        owner = active.discrete_fairing.source
    if owner is not None:
        return [owner] if owner.type == "MESH" else []
    chosen = {o.name: o for o in (*context.selected_objects, active) if o is not None}
    return [o for o in chosen.values() if o.type == "MESH"]


class FairingSettings:
    """Mix-in of annotations for an operator or a property group."""

    levels: IntProperty(
        name="Levels",
        description="Each level splits every face in four: 2 or 3 show the shape, 4 and more are for close-ups",
        default=3,
        min=1,
        max=10,
        soft_max=5,
    )
    energy: EnumProperty(
        name="Fairness",
        description=ENERGY_MEANING,
        items=ENERGIES,
        default=DEFAULT_ENERGY,
    )
    interpolation: EnumProperty(
        name="Vertices",
        description="Whether the surface passes through the vertices of the source, near them, or where Subdivision Surface would",
        items=INTERPOLATIONS,
        default="AUTO",
    )
    limit: FloatProperty(
        name="Follow",
        description="How closely the surface keeps to Subdivision Surface: at 1 thin walls do not wave, at 0 it is free",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="How far the surface may pass from each vertex, in its unit: a little already removes most bumps",
        default=0.02,
        min=0.0,
        soft_max=1.0,
        precision=4,
    )
    tolerance_unit: EnumProperty(
        name="Tolerance Unit",
        description="Whether the tolerance is a share of the mean edge length or a length in the scene",
        items=TOLERANCE_UNITS,
    )
    tolerance_group: StringProperty(
        name="Tolerance Group",
        description="Vertex group or float attribute that multiplies the tolerance: where it is 0, the surface passes through the vertex",
        search=_vertex_values,
        search_options={"SUGGESTION"},  # modifiers may create groups that do not exist yet
    )
    pull_group: StringProperty(
        name="Pull Group",
        description="Vertex group or float attribute: how strongly each vertex attracts the surface, from 0 to 1 in a group",
        search=_vertex_values,
        search_options={"SUGGESTION"},
    )
    pad_size: FloatProperty(
        name="Hold Softly",
        description="Removes the marks of vertices in reflections: at 0 each holds the surface at a point, at 1 over the faces around",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    tension: FloatProperty(
        name="Tension",
        description="Keeps fins, ears and ends of limbs from swelling (not with Flow Lines)",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    boundary: EnumProperty(
        name="Boundary",
        description="What happens to open borders",
        items=BOUNDARIES,
        default="CORNERS",
    )
    symmetry_plane: EnumProperty(
        name="Symmetry Plane",
        description="The surface crosses this plane of the object as if its mirror image were there, as for half a hull",
        items=SYMMETRY_PLANES,
    )

    mesh_source: EnumProperty(
        name="Control Mesh", description="Which state of the source is faired", items=MESH_SOURCES
    )
    use_selection: BoolProperty(
        name="Selected Faces Only",
        description="Fairs the selected faces only, and subdivides all others to match without changing their shape",
        default=False,
    )
    joint: EnumProperty(
        name="Joint",
        description="How the faired faces meet those that keep their shape",
        items=JOINTS,
        default="TANGENT",
    )

    use_crease_attribute: BoolProperty(
        name="Edge Creases",
        description="Creased edges (Shift E in Edit Mode) become sharp curves or soft turns, and creased vertices corners",
        default=True,
    )
    crease_threshold: FloatProperty(
        name="Threshold",
        description="Creases of at least this weight are sharp; below it the surface turns softly, the wider the lower the weight",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    use_sharp_edges: BoolProperty(
        name="Sharp Edges",
        description="Edges marked sharp become sharp curves as well",
        default=False,
    )
    use_crease_angle: BoolProperty(
        name="Crease Angle",
        description="Edges folded by more than this angle become sharp curves",
        default=False,
    )
    crease_angle: FloatProperty(
        name="Angle",
        description="The angle between two faces above which their edge stays sharp",
        default=radians(40),
        min=0.0,
        max=radians(180),
        subtype="ANGLE",
    )
    use_corner_angle: BoolProperty(
        name="Corner Angle",
        description="Borders and creases that turn by more than this angle at a vertex get a corner there, not a bend",
        default=False,
    )
    corner_angle: FloatProperty(
        name="Angle",
        description="The turn of a border or crease above which its vertex is a corner",
        default=radians(60),
        min=0.0,
        max=radians(180),
        subtype="ANGLE",
    )

    metric_exponent: FloatProperty(
        name="Spacing",
        description="How strongly edge lengths shape the surface: at 1 faces keep their proportions, at 0 all count the same",
        default=0.5,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    repair: EnumProperty(
        name="Defects",
        description="What happens to a mesh with defects",
        items=REPAIRS,
    )
    weld: FloatProperty(
        name="Weld",
        description="Joins vertices that are no farther apart than this, in scene units, and leaves the source as it is",
        default=0.0,
        min=0.0,
        soft_max=0.1,
        precision=4,
        subtype="DISTANCE",
    )
    use_shape_keys: BoolProperty(
        name="Shape Keys",
        description="Fairs every shape key of the source too, so that you can animate the surface with them",
        default=True,
    )
    copy_modifiers: BoolProperty(
        name="Copy Modifiers",
        description="Gives the surface the modifiers of the source, such as its armature",
        default=False,
    )
    hide_source: BoolProperty(
        name="Hide Source",
        description="Hides the source afterwards, because both overlap; Show Source shows it again",
        default=True,
    )
    shade_smooth: BoolProperty(
        name="Shade Smooth",
        description="Shades all faces smooth except at creases and sharp edges; off: each like its source face",
        default=True,
    )


class FitAmount:
    """Mix-in of annotations: how closely a surface follows a scan."""

    amount: EnumProperty(
        name="Amount",
        description="How closely the surface follows the scan",
        items=(
            ("AUTO", "Automatic", "As closely as the noise of the scan allows"),
            (
                "TOLERANCE",
                "Within Tolerance",
                "The calmest surface with 95 % of the scan within it",
            ),
        ),
        default="AUTO",
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Distance that 95 % of the scan's points are within",
        default=0.001,
        min=1e-9,
        subtype="DISTANCE",
        unit="LENGTH",
        precision=5,
    )


def copy_settings(source: Settings, target: Any) -> None:
    """Copies every setting of `source` to `target` (operator properties or property group)."""
    for name in NAMES:
        setattr(target, name, getattr(source, name))


def fill_in(settings: FairingSettings, target: Any) -> None:
    """Copies `settings` to operator properties that are unset; values of the last run count as unset."""
    for name in NAMES:
        if not target.is_property_set(name):
            setattr(target, name, getattr(settings, name))


def take_near(given: Any) -> None:
    """A given tolerance implies Near, a given limit amount Limit, unless told otherwise."""
    if given.is_property_set("interpolation"):
        return
    near, limit = any(map(given.is_property_set, OF_NEAR)), given.is_property_set("limit")
    if near or limit:
        given.interpolation = "APPROXIMATE" if near else "LIMIT"


class FAIRING_PG_settings(FairingSettings, bpy.types.PropertyGroup):
    """The settings that the panel shows; stored with the scene."""


ATTACHED = ((bpy.types.Scene, "discrete_fairing", FAIRING_PG_settings),)
