# SPDX-License-Identifier: GPL-3.0-or-later
"""The switch Live."""

from typing import cast

import bpy

from .. import core, memory
from ..blender import Context, Object
from ..check.cages import choice
from ..live import switch
from ..mesh.modifiers import copy_modifiers
from ..mesh.object import is_in_view_layer, new_surface, nothing_left_behind
from ..mesh.read import control_mesh, read_mesh
from ..mesh.world_shape import world_shape
from ..poll import in_mode
from ..settings import Settings, is_evaluated, wants_modifiers
from ..surfaces import place
from .mixins import Action

_MODES = {"OBJECT", "EDIT_MESH", "SCULPT"}


class OBJECT_OT_fairing_live(Action, bpy.types.Operator):
    """Update the surface while you edit the control mesh, or no longer; makes one if there is none"""

    bl_idname = "object.fairing_live"
    bl_label = "Live"

    @staticmethod
    def _active_reason(context: Context) -> str:
        active = context.active_object
        if active is None or active.type != "MESH":
            return "Select a mesh object first"
        return switch.why_not(active) if active.discrete_fairing.source is not None else ""

    reasons = (
        lambda _: core.why_missing(),
        in_mode("Go to Object Mode, Edit Mode or Sculpt Mode first", *_MODES),
        _active_reason,
    )

    def act(self, context: Context) -> None:
        targets = switch.active_surfaces(context)
        if any(map(switch.is_on, targets)):
            for target in targets:
                switch.switch_off(target, context)
            return
        with nothing_left_behind():
            targets = targets or [self._make(context)]
        for target in targets:
            source = cast(Object, memory.source_of(target))
            if is_in_view_layer(context, source):  # hidden, it could not be edited or followed
                source.hide_set(False)
            switch.switch_on(target)
            if switch.problem(target):
                self.report({"WARNING"}, switch.problem(target))

    def _make(self, context: Context) -> Object:
        """A faired object of the active mesh, with the panel's settings and a live first surface."""
        source = cast(Object, context.active_object)
        settings = Settings.of(context.scene.discrete_fairing)
        with control_mesh(context, source, is_evaluated(settings)) as edited:
            cage = world_shape(source).of_arrays(read_mesh(edited))
        settings = settings.for_source(source, choice(settings, cage))
        target = new_surface(context, source, f"{source.name} Fair")
        memory.remember(target, source, settings, {})
        place.note(source, target)
        if wants_modifiers(settings):
            for sentence in copy_modifiers(context, source, target):
                self.report({"INFO"}, sentence)
        return target
