# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Border, and the table of joints between objects."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import bpy

from .. import errors
from ..blender import Context, Object
from ..check import joints
from ..check.defects import bring_into_view, select_defects
from ..choices import JOINTS
from ..errors import JobError
from ..fields import choice, switch, whole
from ..jobs.fair import Job
from ..memory import source_of
from ..mesh.read import source_objects
from ..poll import LINKED_SURFACE, in_mode, needs
from ..settings import Settings
from ..surfaces import neighbours
from ..surfaces.freshness import is_own
from ..words import counted
from .fair import Fairing, can_fair
from .mixins import Action


def _pair(context: Context) -> tuple[Object, Object]:
    """The surface and its future neighbour, which poll has found."""
    return cast("tuple[Object, Object]", neighbours.pair(context))


class OBJECT_OT_fairing_match_border(Fairing, bpy.types.Operator):
    """Make the border of this surface meet that of the other selected object; of two surfaces, the active one changes"""

    bl_idname = "object.fairing_match_border"
    bl_label = "Match Border"

    joint: choice("Joint", "How the border meets the other object", JOINTS, "TANGENT")
    both: switch(
        "Both Change", "Each surface turns by half. Without it the other object stays as it is"
    )

    reasons = (
        can_fair,
        needs(neighbours.pair, "Select a faired surface and the one object that it is to meet"),
        needs(lambda context: is_own(_pair(context)[0]), LINKED_SURFACE),
    )

    def make_jobs(self, context: Context) -> list[Job]:
        target, other = _pair(context)
        if not self.both:
            return [self._job(context, target, other)]
        reason = neighbours.why_not_both(target, other)
        if reason or not is_own(other):
            raise JobError(reason or LINKED_SURFACE)
        return [self._job(context, *pair) for pair in ((other, target), (target, other))]

    def _job(self, context: Context, target: Object, other: Object) -> Job:
        settings = replace(Settings.of(target.discrete_fairing), joint=self.joint)
        source = cast(Object, source_of(target))
        return Job(context, source, settings, target, neighbour=other, halfway=self.both)

    def after(self, context: Context, jobs: Sequence[Job]) -> None:
        """The other stops meeting a surface that now takes all of the change."""
        target = jobs[-1].target
        other = neighbours.neighbour_of(target)
        if not self.both and other is not None and neighbours.neighbour_of(other) == target:
            other.discrete_fairing.neighbour = None


class OBJECT_OT_fairing_joints(Action, bpy.types.Operator):
    """Measure gaps, kinks and jumps of curvature where the borders of the selected objects meet"""

    bl_idname = "object.fairing_joints"
    bl_label = "Check Joints"
    bl_options = {"REGISTER"}

    reasons = (
        in_mode("Go to Object Mode first", "OBJECT"),
        needs(lambda c: len(source_objects(c)) > 1, "Select two mesh objects or more first"),
    )

    def act(self, context: Context) -> str:
        with errors.explained("Check Joints"):
            found = joints.measure(context)
        if not found:
            return "No two borders of these objects meet"
        worst = max(found, key=lambda row: row.kink)
        return f"{counted(len(found), 'joint')}, listed in the panel Check; the worst is {worst.text()}"


class OBJECT_OT_fairing_select_joint(Action, bpy.types.Operator):
    """Select the vertex of this joint with the largest kink in Edit Mode, and bring it into view"""

    bl_idname = "object.fairing_select_joint"
    bl_label = "Show Joint"

    index: whole("Joint", "Which line of the table", min=0, options={"HIDDEN"})

    reasons = (needs(lambda _: joints.rows(), "Press Check Joints first"),)

    def act(self, context: Context) -> str:
        rows = joints.rows()
        target = rows[self.index].first.find() if self.index < len(rows) else None
        if target is None or rows[self.index].worst >= len(target.data.vertices):
            return "This joint is no longer there"
        select_defects(context, target, "vertex", [rows[self.index].worst])
        bring_into_view(context)
        return ""
