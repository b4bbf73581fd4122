# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes single border edges smooth, straight or free, whatever the surface's setting."""

import bpy

from ..blender import Context
from ..choices import EDGE_BOUNDARIES
from ..errors import JobError
from ..fields import choice
from ..mesh.boundary_marks import mark_selected, select_marked
from ..poll import in_edit_mode
from ..words import counted
from .mixins import Action

_REASONS = in_edit_mode("border edges")
_NAMES = {key: name for key, name, *_ in EDGE_BOUNDARIES}


class OBJECT_OT_fairing_boundary(Action, bpy.types.Operator):
    """Make the selected edges of open borders smooth, straight or free, whatever the setting Boundary is"""

    bl_idname = "object.fairing_boundary"
    bl_label = "Boundary of Edges"

    boundary: choice("Boundary", "What these edges become", EDGE_BOUNDARIES)

    reasons = _REASONS

    def act(self, context: Context) -> str:
        meshes = [o.data for o in context.objects_in_mode_unique_data]
        count = sum(mark_selected(mesh, self.boundary) for mesh in meshes)
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

    reasons = _REASONS

    def act(self, context: Context) -> str:
        meshes = [o.data for o in context.objects_in_mode_unique_data]
        count = sum(select_marked(mesh, self.boundary) for mesh in meshes)
        return "" if count else f"No border edge is marked {_NAMES[self.boundary]}"
