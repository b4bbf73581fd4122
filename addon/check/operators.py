# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Mesh, and what follows from it: show a defect, mend a defect."""

import bpy
from bpy.props import IntProperty

from .. import native
from ..read.source import source_objects
from ..refusal import Refusing
from . import messages, record, repair
from .selection import select_defects, select_in_all


def why_not(context):
    """Why nothing can be checked here, in one sentence; empty when it can."""
    if native.why_missing():
        return native.why_missing()
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        return "Check Mesh works in Object Mode and Edit Mode"
    targets = source_objects(context)
    if not targets:
        return "Select a mesh object first"
    if any(t.library or t.data.library for t in targets):
        return "This mesh is linked from another file: make it local first (Object > Relations > Make Local)"
    return ""


class _Checking(Refusing):
    why_not = staticmethod(why_not)


class MESH_OT_fairing_check(_Checking, bpy.types.Operator):
    """Look for everything in the selected meshes that fairing would stumble over, and select it in Edit Mode"""

    bl_idname = "mesh.fairing_check"
    bl_label = "Check Mesh"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        found = [(t, record.check_object(context, t)) for t in source_objects(context)]
        bad = [(t, defects) for t, defects in found if defects]
        for target, defects in bad:
            self.report({"WARNING"}, f"{target.name}: {messages.what(defects[0])}")
        if not bad:
            self.report({"INFO"}, "Nothing is wrong")
            return {"FINISHED"}
        try:
            select_in_all(context, [(t, _groups(defects)) for t, defects in bad])
        except RuntimeError as error:  # a hidden collection, an object that cannot be edited
            self.report({"WARNING"}, f"The elements cannot be shown: {error}")
        for target, defects in found:
            record.store(context, target, defects)
        return {"FINISHED"}


class _AtDefect(_Checking):
    index: IntProperty(name="Defect", description="Which line of the check", min=0, options={"HIDDEN"})

    def _defect(self, context):
        """(object, defect, all its defects), checked anew if the mesh was changed since; the defect is None if it is gone."""
        target = context.active_object
        known = record.recall(target)
        code = known[0][self.index]["code"] if known and self.index < len(known[0]) else None
        defects = known[0] if known and not known[1] else record.check_object(context, target)
        return target, next((d for d in defects if d["code"] == code), None), defects


class MESH_OT_fairing_select_defect(_AtDefect, bpy.types.Operator):
    """Select in Edit Mode what this line is about"""

    bl_idname = "mesh.fairing_select_defect"
    bl_label = "Select"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        target, defect, defects = self._defect(context)
        if defect is None:
            self.report({"INFO"}, "That is mended by now")
            return {"FINISHED"}
        select_defects(context, target, defect["kind"], defect["elements"])
        record.store(context, target, defects)
        return {"FINISHED"}


class MESH_OT_fairing_repair(_AtDefect, bpy.types.Operator):
    """Mend this in the mesh itself; Undo brings it back"""

    bl_idname = "mesh.fairing_repair"
    bl_label = "Mend"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        target, defect, _ = self._defect(context)
        if defect is None or repair.label(defect["code"]) is None:
            self.report({"INFO"}, "There is nothing to mend here")
            return {"CANCELLED"}
        select_defects(context, target, defect["kind"], defect["elements"])
        repair.repair(target, defect)
        left = record.check_object(context, target)
        select_in_all(context, [(target, _groups(left))])
        record.store(context, target, left)
        self.report({"INFO"}, messages.what(left[0]) if left else "Mended: nothing is wrong any more")
        return {"FINISHED"}


def _groups(defects):
    return [(d["kind"], d["elements"]) for d in defects]


CLASSES = (MESH_OT_fairing_check, MESH_OT_fairing_select_defect, MESH_OT_fairing_repair)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
