# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair in Place: it changes meshes themselves, with undo."""

from collections.abc import Iterator, Sequence

import bpy

from ..blender import Context, Object
from ..choices import (
    DEFAULT_ENERGY,
    ENERGIES,
    ENERGY_MEANING,
    JOINTS_IN_PLACE,
    VERTICES_IN_PLACE,
)
from ..errors import JobError
from ..fields import choice, factor, length
from ..jobs import in_place
from ..mesh.read import source_objects
from ..poll import IN_EITHER_MODE, of_meshes
from ..settings import Settings, values_of
from .fair import InMeshes, can_fair
from .mixins import Shown


class OBJECT_OT_fairing_in_place(Shown, InMeshes, bpy.types.Operator):
    """Fair the selected faces of this mesh itself, the rest is unchanged; in Object Mode remove the noise of whole meshes"""

    bl_idname = "object.fairing_in_place"
    bl_label = "Fair in Place"

    joint: choice(
        "Joint", "How the selection meets the faces around it", JOINTS_IN_PLACE, "TANGENT"
    )
    factor: factor("Factor", "How far the vertices move towards the fairest surface", 1.0)
    vertices: choice(
        "Vertices", "How the vertices inside the selection are treated", VERTICES_IN_PLACE
    )
    noise: length(
        "Noise",
        "Noise of measured vertices in scene units, root mean square; 0: estimated from them",
        soft_max=1.0,
        precision=4,
    )
    energy: choice("Fairness", ENERGY_MEANING, ENERGIES, DEFAULT_ENERGY)
    tension: factor("Tension", "Keeps the surface from swelling")

    reasons = (can_fair, IN_EITHER_MODE, of_meshes(source_objects))

    def _are_measured(self, context: Context) -> bool:
        """Nothing holds whole meshes but their own vertices."""
        return self.vertices == "MEASURED" or context.mode == "OBJECT"

    def shown(self, context: Context) -> Iterator[str]:
        measured = self._are_measured(context)
        if context.mode == "EDIT_MESH":
            yield from ("joint", "vertices")
        if measured:
            yield "noise"
        yield "factor"
        if not measured:
            yield "energy"
            if self.energy != "MINIMUM_VARIATION":
                yield "tension"

    def make_jobs(self, context: Context) -> list[in_place.InPlaceJob]:
        options = values_of(in_place.InPlaceOptions, self, measured=self._are_measured(context))
        settings = Settings.of(context.scene.discrete_fairing)
        return [
            in_place.InPlaceJob(context, target, settings, options) for target in _targets(context)
        ]

    def write(self, _context: Context, jobs: Sequence[in_place.InPlaceJob]) -> None:
        for job in jobs:
            job.apply()
            for sentence in job.notes:
                self.report({"INFO"}, sentence)
            for sentence in job.warnings():
                self.report({"WARNING"}, sentence)


def _targets(context: Context) -> list[Object]:
    """The objects whose faces are faired; raises JobError."""
    if context.mode == "EDIT_MESH":
        objects = [o for o in context.objects_in_mode_unique_data if _has_selection(o)]
        if not objects:
            raise JobError("Select the faces to fair: no face is selected.")
        return objects
    objects = list({o.data: o for o in source_objects(context)}.values())
    for target in objects:
        if target.data.shape_keys:
            raise JobError(
                f"{target.name}: Press Tab, select all, and fair in Edit Mode. In Object Mode, meshes with shape "
                "keys are not changed."
            )
    return objects


def _has_selection(target: Object) -> bool:
    target.update_from_editmode()
    return target.data.total_face_sel > 0
