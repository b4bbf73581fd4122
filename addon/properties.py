# SPDX-License-Identifier: GPL-3.0-or-later
"""Every setting once, as Blender's property, for operator, panel, command line and stored surfaces.

A new setting is added here, to `Settings` (settings.py), core.fair_arguments and ui/layout.py; the
command line follows by itself.
"""

from math import radians
from typing import Any

import bpy

from . import vertex_values
from .blender import Context, Object
from .choices import (
    BOUNDARIES,
    DEFAULT_ENERGY,
    ENERGIES,
    ENERGY_MEANING,
    FIT_AMOUNTS,
    INTERPOLATIONS,
    JOINTS,
    MESH_SOURCES,
    REPAIRS,
    SYMMETRY_PLANES,
    TOLERANCE_UNITS,
)
from .fields import angle, choice, factor, length, number, switch, text, whole
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

    levels: whole(
        "Levels",
        "Each level splits every face in four: 2 or 3 show the shape, 4 and more are for close-ups",
        3,
        min=1,
        max=10,
        soft_max=5,
    )
    energy: choice("Fairness", ENERGY_MEANING, ENERGIES, DEFAULT_ENERGY)
    interpolation: choice(
        "Vertices",
        "Whether the surface passes through the vertices of the source, near them, or where Subdivision Surface would",
        INTERPOLATIONS,
        "AUTO",
    )
    limit: factor(
        "Follow",
        "How closely the surface keeps to Subdivision Surface: at 1 thin walls do not wave, at 0 it is free",
        1.0,
    )
    tolerance: number(
        "Tolerance",
        "How far the surface may pass from each vertex, in its unit: a little already removes most bumps",
        0.02,
        min=0.0,
        soft_max=1.0,
        precision=4,
    )
    tolerance_unit: choice(
        "Tolerance Unit",
        "Whether the tolerance is a share of the mean edge length or a length in the scene",
        TOLERANCE_UNITS,
    )
    tolerance_group: text(
        "Tolerance Group",
        "Vertex group or float attribute that multiplies the tolerance: where it is 0, the surface passes through the vertex",
        search=_vertex_values,
        search_options={"SUGGESTION"},  # modifiers may create groups that do not exist yet
    )
    pull_group: text(
        "Pull Group",
        "Vertex group or float attribute: how strongly each vertex attracts the surface, from 0 to 1 in a group",
        search=_vertex_values,
        search_options={"SUGGESTION"},
    )
    pad_size: factor(
        "Hold Softly",
        "Removes the marks of vertices in reflections: at 0 each holds the surface at a point, at 1 over the faces around",
        1.0,
    )
    tension: factor(
        "Tension", "Keeps fins, ears and ends of limbs from swelling (not with Flow Lines)"
    )
    boundary: choice("Boundary", "What happens to open borders", BOUNDARIES, "CORNERS")
    symmetry_plane: choice(
        "Symmetry Plane",
        "The surface crosses this plane of the object as if its mirror image were there, as for half a hull",
        SYMMETRY_PLANES,
    )

    mesh_source: choice("Control Mesh", "Which state of the source is faired", MESH_SOURCES)
    use_selection: switch(
        "Selected Faces Only",
        "Fairs the selected faces only, and subdivides all others to match without changing their shape",
    )
    joint: choice(
        "Joint", "How the faired faces meet those that keep their shape", JOINTS, "TANGENT"
    )

    use_crease_attribute: switch(
        "Edge Creases",
        "Creased edges (Shift E in Edit Mode) become sharp curves or soft turns, and creased vertices corners",
        True,
    )
    crease_threshold: factor(
        "Threshold",
        "Creases of at least this weight are sharp; below it the surface turns softly, the wider the lower the weight",
        1.0,
    )
    use_sharp_edges: switch("Sharp Edges", "Edges marked sharp become sharp curves as well")
    use_crease_angle: switch(
        "Crease Angle", "Edges folded by more than this angle become sharp curves"
    )
    crease_angle: angle(
        "Angle", "The angle between two faces above which their edge stays sharp", radians(40)
    )
    use_corner_angle: switch(
        "Corner Angle",
        "Borders and creases that turn by more than this angle at a vertex get a corner there, not a bend",
    )
    corner_angle: angle(
        "Angle", "The turn of a border or crease above which its vertex is a corner", radians(60)
    )

    metric_exponent: factor(
        "Spacing",
        "How strongly edge lengths shape the surface: at 1 faces keep their proportions, at 0 all count the same. "
        "With faces kept flat 0.95 at least",
        0.5,
    )
    repair: choice("Defects", "What happens to a mesh with defects", REPAIRS)
    weld: length(
        "Weld",
        "Joins vertices that are no farther apart than this, in scene units, and leaves the source as it is",
        soft_max=0.1,
        precision=4,
    )
    use_shape_keys: switch(
        "Shape Keys",
        "Fairs every shape key of the source too, so that you can animate the surface with them",
        True,
    )
    copy_modifiers: switch(
        "Copy Modifiers", "Gives the surface the modifiers of the source, such as its armature"
    )
    hide_source: switch(
        "Hide Source",
        "Hides the source afterwards, because both overlap; Show Source shows it again",
        True,
    )
    shade_smooth: switch(
        "Shade Smooth",
        "Shades all faces smooth except at creases and sharp edges; off: each like its source face",
        True,
    )


class FitAmount:
    """Mix-in of annotations: how closely a surface follows a scan."""

    amount: choice(
        "Amount",
        "How closely the surface follows the scan",
        FIT_AMOUNTS,
    )
    tolerance: number(
        "Tolerance",
        "Distance that 95 % of the scan's points are within",
        0.001,
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
