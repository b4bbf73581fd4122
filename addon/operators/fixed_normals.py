# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixes the surface's normal at vertices, and frees it again."""

import bpy

from ..blender import Context, Object
from ..errors import JobError
from ..mesh import fixed_normals
from ..mesh.read import control_mesh
from ..poll import in_edit_mode
from ..words import counted
from .mixins import Action

_REASONS = in_edit_mode("vertices")


class OBJECT_OT_fairing_fix_normal(Action, bpy.types.Operator):
    """Give the surface the normal that the mesh has, custom normals included, at the selected vertices"""

    bl_idname = "object.fairing_fix_normal"
    bl_label = "Fix Normal"

    reasons = _REASONS

    def act(self, context: Context) -> str:
        count = sum(_fix_own(context, source) for source in context.objects_in_mode_unique_data)
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
