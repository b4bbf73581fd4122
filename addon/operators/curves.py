# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface from Curves: the fairest surface over a network of curves, which it follows."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, cast

import bpy

from ..blender import Answer, Context, Object
from ..choices import ENERGIES, ENERGY_MEANING
from ..fields import choice, whole
from ..jobs.fair import Job
from ..mesh.object import Reference
from ..mesh.read_curves import has_curves
from ..poll import in_mode, needs
from ..settings import Settings
from ..surfaces import curve_cage
from ..surfaces.curve_cage import CageSettings
from .fair import Fairing, can_fair
from .mixins import Shown

# The surface passes through the curves, is free between them, and ends as they do.
_OURS: dict[str, Any] = {
    "interpolation": "APPROXIMATE",
    "tolerance": 0.0,
    "tolerance_unit": "SCENE",
    "tolerance_group": "",
    "pull_group": curve_cage.HOLD,
    "boundary": "CORNERS",
    "symmetry_plane": "NONE",
    "mesh_source": "ORIGINAL",
    "use_selection": False,
    "use_crease_attribute": True,
    "use_sharp_edges": False,
    "use_crease_angle": False,
    "repair": "REFUSE",
    "tension": 0.0,
}


def curve_objects(context: Context) -> list[Object]:
    """The selected objects with curves, by name."""
    return sorted((o for o in context.selected_objects if has_curves(o)), key=lambda o: o.name)


class OBJECT_OT_fairing_curves(Shown, CageSettings, Fairing, bpy.types.Operator):
    """Make the fairest surface through the selected curves that cross; wire edges of meshes are curves too"""

    bl_idname = "object.fairing_curves"
    bl_label = "Fair Surface from Curves"

    levels: whole(
        "Levels",
        "How often every face of the control mesh is split in four",
        3,
        min=1,
        max=10,
        soft_max=5,
    )
    energy: choice("Fairness", ENERGY_MEANING, ENERGIES, "MINIMUM_VARIATION")

    reasons = (
        in_mode("Press Tab first: surfaces from curves are made in Object Mode", "OBJECT"),
        can_fair,
        needs(curve_objects, "Select curves that cross each other first"),
    )

    def shown(self, _context: Context) -> Iterable[str]:
        return ("levels", "energy", *CageSettings.__annotations__)

    def invoke(self, context: Context, event: bpy.types.Event) -> Answer:
        self._cage: Reference | None = None
        return self._tidied(super().invoke(context, event))

    def execute(self, context: Context) -> Answer:
        self._cage = None
        return self._tidied(super().execute(context))

    def _end(self, context: Context) -> Answer:
        return self._tidied(super()._end(context))

    def cancel(self, context: Context) -> None:
        super().cancel(context)
        self._tidied({"CANCELLED"})

    def _tidied(self, answer: Answer) -> Answer:
        """Removes the control mesh if no surface was made."""
        cage = self._cage.find() if self._cage is not None else None  # undo may have removed it
        if answer == {"CANCELLED"}:
            self._cage = None
            if cage is not None:
                mesh = cage.data
                bpy.data.objects.remove(cage)
                bpy.data.meshes.remove(mesh)
        return answer

    def make_jobs(self, context: Context) -> list[Job]:
        cage = self._cage.find() if self._cage is not None else None
        if cage is None:
            sources = curve_objects(context)
            name = "Curves" if len(sources) > 1 else sources[0].name
            cage, self._found = curve_cage.new_cage(context, f"{name} Network", sources, self)
            self._cage = Reference(cage)
        own = replace(Settings.of(context.scene.discrete_fairing), **_OURS)
        own = replace(own, levels=self.levels, energy=self.energy)
        return [Job(context, cage, own)]

    def after(self, context: Context, jobs: Any) -> None:
        faces = len(self._found.mesh.faces)
        self.report({"INFO"}, f"{self._found.summary}: {faces:,} faces")
        for sentence in self._found.remarks:
            self.report({"WARNING"}, sentence)
        cast(Object, jobs[0].source).hide_set(True)
