# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh says of single elements: the boundary of border edges, fixed normals, faces kept flat."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import degrees, radians
from typing import Any

import bmesh
import bpy
import numpy as np

from .. import core
from ..blender import Context, Mesh, Object, column
from ..choices import EDGE_BOUNDARIES
from ..errors import JobError
from ..fields import choice, number, switch
from ..memory import source_of
from ..mesh import marks
from ..mesh.marks import BOUNDARY, FLAT, NORMAL, border_edges, own_normals
from ..mesh.read import read_mesh, source_objects
from ..mesh.world_shape import world_shape
from ..poll import IN_EITHER_MODE, in_edit_mode, of_meshes
from ..settings import Settings
from ..ui.active import active_settings
from ..words import counted
from .mixins import Action, Shown

_OF_EDGES, _OF_VERTICES = in_edit_mode("border edges"), in_edit_mode("vertices")
_NAMES = {key: name for key, name, *_ in EDGE_BOUNDARIES}
_NUMBERS = {key: number for key, *_, number in EDGE_BOUNDARIES}


@contextmanager
def _in_object_mode(context: Context) -> Iterator[None]:
    """Object Mode, the only mode in which every version of Blender writes all marks."""
    is_edited = context.mode == "EDIT_MESH"
    if is_edited:
        bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        if is_edited:
            bpy.ops.object.mode_set(mode="EDIT")


def _selected(elements: Any) -> np.ndarray:
    return column(elements, "select", bool)


class _Marking(Action):
    """The common part: marks selected elements of the meshes in Edit Mode."""

    def mark(self, mesh: Mesh) -> int:
        """Marks elements of `mesh`, in Object Mode; returns their number."""
        raise NotImplementedError

    def said(self, count: int) -> str:
        """The report; raises JobError if nothing is selected."""
        raise NotImplementedError

    def act(self, context: Context) -> str:
        meshes = [o.data for o in context.objects_in_mode_unique_data]
        with _in_object_mode(context):
            count = sum(map(self.mark, meshes))
        return self.said(count)


class OBJECT_OT_fairing_boundary(_Marking, bpy.types.Operator):
    """Make the selected edges of open borders smooth, straight or free, whatever the setting Boundary is"""

    bl_idname = "object.fairing_boundary"
    bl_label = "Boundary of Edges"

    boundary: choice("Boundary", "What these edges become", EDGE_BOUNDARIES)

    reasons = _OF_EDGES

    def mark(self, mesh: Mesh) -> int:
        chosen = _selected(mesh.edges) & border_edges(mesh)
        return marks.put(mesh, BOUNDARY, chosen, _NUMBERS[self.boundary])

    def said(self, count: int) -> str:
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
        count = sum(self._select(o.data) for o in context.objects_in_mode_unique_data)
        return "" if count else f"No border edge is marked {_NAMES[self.boundary]}"

    def _select(self, mesh: Mesh) -> int:
        values, edit = marks.read(mesh, BOUNDARY), bmesh.from_edit_mesh(mesh)
        if values is None:
            return 0
        are_chosen = (values == _NUMBERS[self.boundary]) & border_edges(mesh)
        chosen = [e for e, is_chosen in zip(edit.edges, are_chosen) if is_chosen and not e.hide]
        for edge in chosen:
            edge.select = True
        edit.select_flush_mode()
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        return len(chosen)


class OBJECT_OT_fairing_fix_normal(_Marking, bpy.types.Operator):
    """Give the surface the normal that the mesh has, custom normals included, at the selected vertices"""

    bl_idname = "object.fairing_fix_normal"
    bl_label = "Fix Normal"

    reasons = _OF_VERTICES

    def mark(self, mesh: Mesh) -> int:
        normals = own_normals(mesh)
        return marks.put(mesh, NORMAL, _selected(mesh.vertices) & normals.any(axis=1), normals)

    def said(self, count: int) -> str:
        if not count:
            raise JobError("Select a vertex with faces first")
        return f"{counted(count, 'normal')} fixed"


class OBJECT_OT_fairing_free_normal(_Marking, bpy.types.Operator):
    """Remove the fixed normal at the selected vertices"""

    bl_idname = "object.fairing_free_normal"
    bl_label = "Free Normal"

    reasons = _OF_VERTICES

    def mark(self, mesh: Mesh) -> int:
        return marks.put(mesh, NORMAL, _selected(mesh.vertices) & marks.marked(mesh, NORMAL), 0)

    def said(self, count: int) -> str:
        return "" if count else "No selected vertex has a fixed normal"


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
        targets, is_edited = _targets(context), context.mode == "EDIT_MESH"
        with _in_object_mode(context):
            settings = Settings.of(active_settings(context))
            count = sum(self._mark(target, is_edited, settings) for target in targets)
        if not count and is_edited:
            raise JobError("Select faces first")
        if not count and not self.clear:
            return "No flat faces found: select faces in Edit Mode to keep them flat"
        return f"{counted(count, 'face')} {'may curve' if self.clear else 'stay flat'}"

    def _mark(self, target: Object, is_edited: bool, settings: Settings) -> int:
        mesh = target.data
        if is_edited:
            chosen = _selected(mesh.polygons)
        elif self.clear:
            chosen = marks.marked(mesh, FLAT)
        else:
            arrays = world_shape(target).of_arrays(read_mesh(mesh))
            chosen = core.found_flats(arrays, settings, degrees(self.angle))
        return marks.put(mesh, FLAT, chosen, not self.clear)


def _targets(context: Context) -> list[Object]:
    """Sources in place of surfaces; one of the objects that share a mesh."""
    sources = [source_of(o) or o for o in source_objects(context)]
    return list({o.data: o for o in sources}.values())
