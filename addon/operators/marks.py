# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh says of single elements: the boundary of border edges, fixed normals, faces kept flat."""

from collections.abc import Iterable
from math import degrees, radians

import bpy

from .. import core
from ..blender import Context, Object
from ..choices import EDGE_BOUNDARIES
from ..errors import JobError
from ..fields import choice, number, switch
from ..memory import source_of
from ..mesh import boundary_marks, fixed_normals, flat_marks
from ..mesh.read import control_mesh, read_mesh, source_objects
from ..mesh.world_shape import world_shape
from ..poll import IN_EITHER_MODE, in_edit_mode, of_meshes
from ..words import counted
from .mixins import Action, Shown

_OF_EDGES, _OF_VERTICES = in_edit_mode("border edges"), in_edit_mode("vertices")
_NAMES = {key: name for key, name, *_ in EDGE_BOUNDARIES}


class OBJECT_OT_fairing_boundary(Action, bpy.types.Operator):
    """Make the selected edges of open borders smooth, straight or free, whatever the setting Boundary is"""

    bl_idname = "object.fairing_boundary"
    bl_label = "Boundary of Edges"

    boundary: choice("Boundary", "What these edges become", EDGE_BOUNDARIES)

    reasons = _OF_EDGES

    def act(self, context: Context) -> str:
        meshes = [o.data for o in context.objects_in_mode_unique_data]
        count = sum(boundary_marks.mark_selected(mesh, self.boundary) for mesh in meshes)
        if not count:
            raise JobError("Select edges at an open border: no edge with a single face is selected")
        return f"{counted(count, 'border edge')}: {_NAMES[self.boundary]}"


class OBJECT_OT_fairing_select_boundary(Action, bpy.types.Operator):
    """Select the border edges that have this Boundary of Edges"""

    bl_idname = "object.fairing_select_boundary"
    bl_label = "Select Boundary of Edges"

    boundary: choice(
        "Boundary", "Which edges are selected", [choice for choice in EDGE_BOUNDARIES if choice[-1]]
    )

    reasons = _OF_EDGES

    def act(self, context: Context) -> str:
        meshes = [o.data for o in context.objects_in_mode_unique_data]
        count = sum(boundary_marks.select_marked(mesh, self.boundary) for mesh in meshes)
        return "" if count else f"No border edge is marked {_NAMES[self.boundary]}"


class OBJECT_OT_fairing_fix_normal(Action, bpy.types.Operator):
    """Give the surface the normal that the mesh has, custom normals included, at the selected vertices"""

    bl_idname = "object.fairing_fix_normal"
    bl_label = "Fix Normal"

    reasons = _OF_VERTICES

    def act(self, context: Context) -> str:
        count = sum(_fix_own(context, source) for source in context.objects_in_mode_unique_data)
        if not count:
            raise JobError("Select a vertex with faces first")
        return f"{counted(count, 'normal')} fixed"


class OBJECT_OT_fairing_free_normal(Action, bpy.types.Operator):
    """Remove the fixed normal at the selected vertices"""

    bl_idname = "object.fairing_free_normal"
    bl_label = "Free Normal"

    reasons = _OF_VERTICES

    def act(self, context: Context) -> str:
        count = sum(fixed_normals.free(o.data) for o in context.objects_in_mode_unique_data)
        return "" if count else "No selected vertex has a fixed normal"


def _fix_own(context: Context, source: Object) -> int:
    with control_mesh(context, source) as mesh:
        normals = fixed_normals.own_normals(mesh)
    return fixed_normals.fix(source.data, normals)


class OBJECT_OT_fairing_flat_faces(Shown, Action, bpy.types.Operator):
    """Keep faces flat, by Bending: in Edit Mode the selected ones, in Object Mode large flat ones between tight rims"""

    bl_idname = "object.fairing_flat_faces"
    bl_label = "Keep Faces Flat"

    clear: switch(
        "Clear", "Let faces curve again: in Edit Mode the selected ones, in Object Mode all"
    )
    angle: number(
        "Angle",
        "In Object Mode: faces that meet at a smaller angle are one flat, if they lie in a plane",
        radians(1.0),
        min=0.0,
        max=radians(30.0),
        subtype="ANGLE",
    )

    reasons = (IN_EITHER_MODE, of_meshes(lambda context: _targets(context)))

    def shown(self, context: Context) -> Iterable[str]:
        return ("clear", "angle") if context.mode == "OBJECT" and not self.clear else ("clear",)

    def act(self, context: Context) -> str:
        targets = _targets(context)
        if context.mode == "EDIT_MESH":
            # the only mode in which every version of Blender writes the marks
            bpy.ops.object.mode_set(mode="OBJECT")
            try:
                count = sum(flat_marks.mark_selected(o.data, not self.clear) for o in targets)
            finally:
                bpy.ops.object.mode_set(mode="EDIT")
            if not count:
                raise JobError("Select faces first")
        elif self.clear:
            count = sum(flat_marks.clear(o.data) for o in targets)
        else:
            count = sum(_mark_found(o, degrees(self.angle)) for o in targets)
            if not count:
                return "No flat faces found: select faces in Edit Mode to keep them flat"
        return f"{counted(count, 'face')} {'may curve' if self.clear else 'stay flat'}"


def _targets(context: Context) -> list[Object]:
    """Sources in place of surfaces; one of the objects that share a mesh."""
    sources = [source_of(o) or o for o in source_objects(context)]
    return list({o.data: o for o in sources}.values())


def _mark_found(target: Object, angle: float) -> int:
    """Marks the flats of `target` (`angle` in degrees); returns their number of faces."""
    arrays = world_shape(target).of_arrays(read_mesh(target.data))
    found = core.module().flats.flats_of(core.measured(arrays), angle)
    flat_marks.mark(target.data, found)
    return int(found.sum())
