# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Selected Faces in Place: the mesh in Edit Mode itself, by request and with undo."""

from collections.abc import Sequence
from typing import Any, cast

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .. import in_place
from ..blender import Answer, Context, Object, registration
from ..choices import DEFAULT_ENERGY, ENERGIES, ENERGY_MEANING, JOINTS
from ..errors import JobError
from .fair import WholeFairing, poll_reason


def _joints() -> tuple[tuple[str, str, str], ...]:
    meanings = {
        "POSITION": "Only the rim of the selection is held: any angle there (G0)",
        "TANGENT": "The selection goes on in the direction of the faces around it (G1)",
        "CURVATURE": "The selection goes on in the bend of the faces around it (like G2)",
    }
    return tuple((key, name, meanings[key]) for key, name, _ in JOINTS)


class OBJECT_OT_fairing_in_place(WholeFairing, bpy.types.Operator):
    """Fair the selected faces of this mesh itself: move their vertices, or refine them too, and nothing around"""

    bl_idname = "object.fairing_in_place"
    bl_label = "Fair Selected Faces in Place"
    bl_options = {"REGISTER", "UNDO"}

    levels: IntProperty(
        name="Levels",
        description="How often the selected faces are split in four, or 0 to move their vertices only",
        default=0,
        min=0,
        max=6,
        soft_max=3,
    )
    joint: EnumProperty(
        name="Joint",
        description="How the selection meets the faces around it",
        items=_joints(),
        default="TANGENT",
    )
    factor: FloatProperty(
        name="Factor",
        description="How far the vertices go to where the surface is fairest",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    release: BoolProperty(
        name="Move Vertices",
        description="The vertices of the selection move too, or if off the surface passes through them",
        default=False,
    )
    vertices: EnumProperty(
        name="Vertices",
        description="What the vertices inside of the selection are",
        items=(
            (
                "FREE",
                "Free",
                "They go to where the surface is fairest, wherever they were: for bumps and holes",
            ),
            (
                "MEASURED",
                "Measured",
                "They are data with noise: the surface passes near them, and they move to it, but for edges marked sharp",
            ),
        ),
    )
    noise: FloatProperty(
        name="Noise",
        description="How far measured vertices are moved in scene units, root mean square, or 0 to find it from them",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        precision=4,
        subtype="DISTANCE",
    )
    energy: EnumProperty(
        name="Fairness",
        description=ENERGY_MEANING,
        items=ENERGIES,
        default=DEFAULT_ENERGY,
    )
    tension: FloatProperty(
        name="Tension",
        description="Draws the surface taut, so that it does not swell",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )

    @staticmethod
    def poll_reason(context: Context) -> str:
        if poll_reason(context):
            return poll_reason(context)
        if context.mode != "EDIT_MESH":
            return "Press Tab first, and select faces: those of the mesh in Edit Mode are faired"
        return ""

    def draw(self, _context: Context) -> None:
        layout = cast(bpy.types.UILayout, self.layout)
        layout.use_property_split = True
        layout.prop(self, "levels")
        layout.prop(self, "joint")
        layout.prop(self, "vertices")
        measured = self.vertices == "MEASURED"
        if measured:
            layout.prop(self, "noise")
        elif self.levels:
            layout.prop(self, "release")
        if measured or self.release or not self.levels:
            layout.prop(self, "factor")
        if measured and not self.levels:
            return
        layout.prop(self, "energy")
        if self.energy != "MINIMUM_VARIATION":
            layout.prop(self, "tension")

    def make_jobs(self, context: Context) -> list[Any]:
        wish = in_place.Wish(
            self.levels,
            self.joint,
            self.energy,
            self.tension,
            self.release,
            self.factor,
            self.vertices == "MEASURED",
            self.noise,
        )
        settings = context.scene.discrete_fairing
        objects = [o for o in context.objects_in_mode_unique_data if _has_selection(o)]
        if not objects:
            raise JobError("Select the faces to fair: no face is selected.")
        return [in_place.InPlaceJob(context, target, settings, wish) for target in objects]

    def finish(self, context: Context, jobs: Sequence[Any]) -> Answer:
        """Changes the meshes, if nobody else has meanwhile."""
        for job in jobs:
            reason = job.why_outdated(context)
            if reason:
                self.report({"ERROR"}, reason)
                return {"CANCELLED"}
        for job in jobs:
            job.apply()
            for sentence in job.notes:
                self.report({"INFO"}, sentence)
            for sentence in job.warnings():
                self.report({"WARNING"}, sentence)
        return {"FINISHED"}


def _has_selection(target: Object) -> bool:
    target.update_from_editmode()
    return target.data.total_face_sel > 0


register, unregister = registration(OBJECT_OT_fairing_in_place)
