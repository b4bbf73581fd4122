# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface on Scan: the fairest surface of a cage near a scan."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from ..blender import Answer, Context, Object, registration
from ..mesh.object import nothing_left_behind, select_only
from ..scan_fit import SCAN_TYPES, FitJob, make_cage
from ..settings import Settings
from .fair import WholeFairing, poll_reason


def _chosen(context: Context) -> tuple[Object | None, list[Object]]:
    """The cage, None where it is to be made; and the scans."""
    selected = [o for o in context.selected_objects if o.type in SCAN_TYPES]
    active = context.active_object
    if len(selected) == 1:
        return None, selected
    if active is None or active not in selected or active.type != "MESH":
        return None, []
    return active, [o for o in selected if o != active]


class OBJECT_OT_fairing_fit(WholeFairing, bpy.types.Operator):
    """Make the fairest surface near the selected scans, from the active mesh as cage or from a cage made for a lone scan"""

    bl_idname = "object.fairing_fit"
    bl_label = "Fair Surface on Scan"
    bl_options = {"REGISTER", "UNDO"}
    cancelled_text = "The fit was cancelled: nothing has changed but a cage that was made"

    levels: IntProperty(
        name="Levels",
        description="How often each face of the cage is split into four",
        default=2,
        min=0,
        max=6,
    )
    amount: EnumProperty(
        name="Amount",
        description="How closely the surface follows the scan",
        items=(
            ("AUTO", "Automatic", "As closely as the noise of the scan allows"),
            (
                "TOLERANCE",
                "Within Tolerance",
                "The calmest surface with 95 % of the scan within it",
            ),
        ),
        default="AUTO",
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Distance that 95 % of the scan's points are within",
        default=0.001,
        min=1e-9,
        subtype="DISTANCE",
        unit="LENGTH",
        precision=5,
    )
    cage_faces: IntProperty(
        name="Faces of Cage",
        description="Faces of the cage that is made where the scan alone is selected",
        default=300,
        min=20,
        max=20000,
        soft_max=2000,
    )

    @staticmethod
    def poll_reason(context: Context) -> str:
        if poll_reason(context):
            return poll_reason(context)
        if context.mode != "OBJECT":
            return "Go to Object Mode first"
        cage, scans = _chosen(context)
        if not scans:
            return "Select the scan, or the scan first and the cage last"
        if cage is None and scans[0].type != "MESH":
            return "A point cloud needs a cage: select it last"
        return ""

    def draw(self, context: Context) -> None:
        layout = cast(bpy.types.UILayout, self.layout)
        layout.use_property_split = True
        layout.prop(self, "levels")
        layout.prop(self, "amount")
        if self.amount == "TOLERANCE":
            layout.prop(self, "tolerance")
        layout.prop(self, "cage_faces")

    def make_jobs(self, context: Context) -> list[FitJob]:
        cage, scans = _chosen(context)
        if cage is None:
            cage = make_cage(context, scans[0], self.cage_faces)
        settings = replace(Settings.of(context.scene.discrete_fairing), levels=self.levels)
        tolerance = self.tolerance if self.amount == "TOLERANCE" else None
        return [FitJob(context, cage, scans, settings, tolerance)]

    def finish(self, context: Context, jobs: Sequence[FitJob]) -> Answer:
        """Makes the objects, if nobody has changed the cages meanwhile."""
        if self.is_outdated(context, jobs):
            return {"CANCELLED"}
        with nothing_left_behind():
            made = [job.write(context) for job in jobs]
        for job in jobs:
            self.report({"INFO"}, f"{job.name}: {job.said()}")
            for sentence in job.warnings():
                self.report({"WARNING"}, sentence)
        select_only(context, made)
        return {"FINISHED"}


register, unregister = registration(OBJECT_OT_fairing_fit)
