# SPDX-License-Identifier: GPL-3.0-or-later
"""Inspection: show, and measure again."""

from typing import Any, cast

import bpy

from ..blender import Answer, Context
from ..fields import choice
from ..inspection import display, viewport_shading
from ..inspection.display import VALUES
from ..inspection.settings import MODES
from ..memory import source_of
from ..mesh.read import source_objects
from ..poll import IN_EITHER_MODE, IN_OBJECT_MODE, Reason, of_meshes
from .mixins import Action


class _Inspecting(Action):
    reasons: tuple[Reason, ...] = (IN_OBJECT_MODE, of_meshes(source_objects))


class OBJECT_OT_fairing_inspect(_Inspecting, bpy.types.Operator):
    """Show the selected objects in stripes or curvature colours; Off restores their own materials"""

    bl_idname = "object.fairing_inspect"
    bl_label = "Inspect Surface"

    mode: choice("Show", "What the objects show", MODES)

    @classmethod
    def description(cls, _context: Context, properties: Any) -> str:
        return next(text for key, _, text, *_ in MODES if key == properties.mode)

    reasons = (IN_EITHER_MODE, of_meshes(source_objects))

    def invoke(self, context: Context, _event: bpy.types.Event) -> Answer:
        """From a button: also switches the viewport beside it, so that the result is visible."""
        space = cast(Any, context.space_data)
        if space is not None and space.type == "VIEW_3D":
            viewport_shading.show(space, self.mode)
        return self.execute(context)

    def act(self, context: Context) -> str:
        for target in source_objects(context):
            target.discrete_fairing_inspection.mode = self.mode
        if self.mode in VALUES and context.mode == "EDIT_MESH":
            return "Press Tab, then Refresh: colours are measured in Object Mode"
        if self.mode == "DEVIATION" and not _has_reference(context):
            self.report(
                {"WARNING"}, "Choose an object under Measured From: this mesh was made from none"
            )
        return ""


def _has_reference(context: Context) -> bool:
    other = context.scene.discrete_fairing_inspection.deviation_object
    return other is not None or all(map(source_of, source_objects(context)))


class OBJECT_OT_fairing_refresh(_Inspecting, bpy.types.Operator):
    """Measure the colours again after the mesh has changed"""

    bl_idname = "object.fairing_refresh"
    bl_label = "Refresh Colours"

    def act(self, context: Context) -> None:
        for target in source_objects(context):
            display.refresh(target, context.scene.discrete_fairing_inspection)
