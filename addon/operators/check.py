# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Mesh; buttons that show a defect or a hole, or mend a defect; and Select Places of a surface."""

from collections.abc import Sequence
from typing import Any, cast

import bpy
import numpy as np
from bpy.props import IntVectorProperty

from .. import core, errors
from ..blender import Context, Object
from ..check.defects import (
    bring_into_view,
    check_object,
    edges_of,
    recall_defects,
    recall_holes,
    select_defects,
    select_in_all,
    store_defects,
)
from ..check.faults import faulty_vertices
from ..fields import whole
from ..jobs.clean import repair, repair_label
from ..mesh.read import active_mesh, source_objects
from ..mesh.write import FAULTS, NO_POINTS, faces_without_points
from ..poll import IN_EITHER_MODE, needs, of_meshes
from ..words import counted
from .mixins import Action


class _Checking(Action):
    reasons = (lambda _: core.why_missing(), IN_EITHER_MODE, of_meshes(source_objects))


class OBJECT_OT_fairing_check(_Checking, bpy.types.Operator):
    """Find every defect in the selected meshes that would stop or disturb fairing, and select it in Edit Mode"""

    bl_idname = "object.fairing_check"
    bl_label = "Check Mesh"

    def act(self, context: Context) -> str:
        found = [(t, check_object(context, t)) for t in source_objects(context)]
        bad = [(t, defects) for t, defects in found if defects]
        for target, defects in bad:
            self.report({"WARNING"}, f"{target.name}: {errors.what(defects[0])}")
        if not bad:
            count = sum(len(recall_holes(target)) for target, _ in found)
            listed = "" if not count else f"; {counted(count, 'hole')} listed in the panel Check"
            return f"Nothing is wrong{listed}"
        try:
            located = [(t, _groups(d)) for t, d in bad if any(one["elements"] for one in d)]
            if located:  # an empty mesh has nothing to select
                select_in_all(context, located)
        except RuntimeError as error:  # a hidden collection, or an object that cannot be edited
            self.report({"WARNING"}, f"The elements cannot be shown: {error}")
        for target, defects in found:
            store_defects(context, target, defects)
        return ""


class _OfActive(Action):
    reasons = (lambda _: core.why_missing(), IN_EITHER_MODE, of_meshes(active_mesh))


class _AtDefect(_OfActive):
    index: whole("Defect", "Which line of the check", min=0, options={"HIDDEN"})

    def _defect(
        self, context: Context
    ) -> tuple[Object, dict[str, Any] | None, list[dict[str, Any]]]:
        """(object, defect or None if gone, all defects), checked again if the mesh has changed."""
        target = cast(Object, context.active_object)
        known = recall_defects(target)
        code = known[0][self.index]["code"] if known and self.index < len(known[0]) else None
        defects = known[0] if known and not known[1] else check_object(context, target)
        return target, next((d for d in defects if d["code"] == code), None), defects


class OBJECT_OT_fairing_select_defect(_AtDefect, bpy.types.Operator):
    """Select the elements of this line in Edit Mode"""

    bl_idname = "object.fairing_select_defect"
    bl_label = "Select"

    def act(self, context: Context) -> str:
        target, defect, defects = self._defect(context)
        if defect is None:
            return "This defect is no longer there"
        select_defects(context, target, defect["kind"], defect["elements"])
        store_defects(context, target, defects)
        return ""


class OBJECT_OT_fairing_repair(_AtDefect, bpy.types.Operator):
    """Repair this defect in the mesh itself; Undo restores it"""

    bl_idname = "object.fairing_repair"
    bl_label = "Repair"

    def act(self, context: Context) -> str:
        target, defect, _ = self._defect(context)
        if defect is None or not repair_label(defect["code"]):
            return "There is nothing to repair here"
        repair(context, target, defect["code"])
        left = check_object(context, target)
        select_in_all(context, [(target, _groups(left))])
        store_defects(context, target, left)
        return errors.what(left[0]) if left else "Repaired: nothing is wrong any more"


class OBJECT_OT_fairing_select_hole(_OfActive, bpy.types.Operator):
    """Select the edges around this hole in Edit Mode, and bring them into view"""

    bl_idname = "object.fairing_select_hole"
    bl_label = "Show Hole"

    edge: IntVectorProperty(
        name="Edge", description="Two vertices of its rim", size=2, min=0, options={"HIDDEN"}
    )

    def act(self, context: Context) -> str:
        target = cast(Object, context.active_object)
        edges = edges_of(context, target, list(self.edge))
        if not edges:
            return "This hole is no longer there"
        known = recall_defects(target)
        select_defects(context, target, "edge", edges)
        if known is not None and not known[1]:
            store_defects(context, target, known[0])
        bring_into_view(context)
        return ""


class OBJECT_OT_fairing_select_faults(Action, bpy.types.Operator):
    """Select in Edit Mode where this surface crosses itself, bulges far from its source, is folded, or has no points of its scan"""

    bl_idname = "object.fairing_select_faults"
    bl_label = "Select Places"

    reasons = (
        needs(
            lambda context: context.mode == "OBJECT" and active_mesh(context),
            "Select a faired surface in Object Mode first",
        ),
        needs(
            lambda context: any(
                name in context.active_object.data.attributes
                for name in (*FAULTS.values(), NO_POINTS)
            ),
            "Nothing to do: nothing was found wrong with this surface",
        ),
        of_meshes(active_mesh),
    )

    def act(self, context: Context) -> None:
        target = cast(Object, context.active_object)
        bare = np.flatnonzero(faces_without_points(target.data))
        groups = (("vertex", faulty_vertices(target.data).tolist()), ("face", bare.tolist()))
        select_in_all(context, [(target, [group for group in groups if group[1]])])


def _groups(defects: list[dict[str, Any]]) -> list[tuple[str, Sequence[Any]]]:
    return [(d["kind"], d["elements"]) for d in defects]
