# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps faces flat: selected ones in Edit Mode, found ones in Object Mode."""

from collections.abc import Iterable
from math import degrees, radians

import bpy

from ..blender import Context, Object
from ..check.flats import ANGLE, find_flats
from ..errors import JobError
from ..fields import number, switch
from ..memory import source_of
from ..mesh import flat_marks
from ..mesh.read import read_mesh, source_objects
from ..mesh.world_shape import world_shape
from ..poll import IN_EITHER_MODE, of_meshes
from ..words import counted
from .mixins import Action, Shown


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
        radians(ANGLE),
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
    found = find_flats(arrays, angle)
    flat_marks.mark(target.data, found)
    return int(found.sum())
