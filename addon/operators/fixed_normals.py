# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixes the surface's normal at vertices, and frees it again."""

import bpy
from bpy.props import EnumProperty
from mathutils import Vector

from ..blender import Context, Object
from ..errors import JobError
from ..mesh import fixed_normals
from ..mesh.read import control_mesh
from ..mesh.world_shape import world_matrix
from ..poll import in_edit_mode
from ..words import counted
from .mixins import Action

_REASONS = in_edit_mode("vertices")
_FROM = (
    ("MESH", "The Mesh", "The normal that the mesh has at the vertex, custom normals included"),
    ("EMPTY", "Z of the Empty", "The Z axis of the empty that is selected beside the mesh"),
)


class OBJECT_OT_fairing_fix_normal(Action, bpy.types.Operator):
    """Give the surface a fixed normal at the selected vertices"""

    bl_idname = "object.fairing_fix_normal"
    bl_label = "Fix Normal"

    origin: EnumProperty(name="From", description="Where the normals come from", items=_FROM)

    reasons = _REASONS

    def act(self, context: Context) -> str:
        sources = context.objects_in_mode_unique_data
        if self.origin == "MESH":
            count = sum(_fix_own(context, source) for source in sources)
        else:
            empties = [o for o in context.selected_objects if o.type == "EMPTY"]
            if len(empties) != 1:
                raise JobError(
                    "Select one empty beside the mesh before Edit Mode: its Z axis is the normal"
                )
            axis = Vector(tuple(row[2] for row in world_matrix(empties[0]))[:3])
            count = sum(fixed_normals.fix_along(source, axis) for source in sources)
        if not count:
            raise JobError("Select a vertex with faces first")
        return f"{counted(count, 'normal')} fixed"


class OBJECT_OT_fairing_free_normal(Action, bpy.types.Operator):
    """Remove the fixed normal at the selected vertices"""

    bl_idname = "object.fairing_free_normal"
    bl_label = "Free Normal"

    reasons = _REASONS

    def act(self, context: Context) -> str:
        count = sum(fixed_normals.free(o.data) for o in context.objects_in_mode_unique_data)
        return "" if count else "No selected vertex has a fixed normal"


def _fix_own(context: Context, source: Object) -> int:
    with control_mesh(context, source) as mesh:
        normals = fixed_normals.own_normals(mesh)
    return fixed_normals.fix(source.data, normals)
