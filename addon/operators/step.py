# SPDX-License-Identifier: GPL-3.0-or-later
"""To CAD: File > Export > Fair Surface (.step), and Show Patches."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import bpy
from bpy.props import StringProperty

from .. import prediction
from ..blender import Answer, Context, Object
from ..cad.fit import PatchJob, refused
from ..cad.settings import PatchSettings, StepSettings, scale_to
from ..cad.step import summary, write_jobs
from ..errors import JobError
from ..memory import source_of
from ..mesh.read import source_objects
from ..poll import needs
from ..settings import PatchOptions
from . import fair, modal
from .mixins import Shown, refusing
from .written_files import ByFileBrowser, written


def _to_fit(context: Context) -> list[Object]:
    """The selected meshes, without sources of selected surfaces."""
    chosen = source_objects(context)
    sources = {source_of(target) for target in chosen}
    return [target for target in chosen if target not in sources]


class _Fitting(fair.Fairing, PatchSettings):
    """The common part: fits patches to the surfaces of all selected objects."""

    reasons = (fair.can_fair, needs(source_objects, "Select a mesh or a faired surface first"))

    def patch_options(self) -> PatchOptions:
        return PatchOptions(self.fit_tolerance, self.fit_angle, self.fit_levels)

    def make_jobs(self, context: Context) -> list[Any]:
        return [PatchJob(context, target, self.patch_options()) for target in _to_fit(context)]

    @refusing
    def execute(self, context: Context) -> Answer:
        return self._block(context, self._prepared(context))


class EXPORT_SCENE_OT_fairing_step(
    Shown, ByFileBrowser, StepSettings, _Fitting, bpy.types.Operator
):
    """Export the selected objects as spline patches: surfaces with their own settings, meshes with the scene's"""

    bl_idname = "export_scene.fairing_step"
    bl_label = "Export Fair Surface"
    bl_options = {"PRESET"}
    cancelled_text = "The export was cancelled: nothing was written"
    filename_ext = ".step"

    filter_glob: StringProperty(default="*.step;*.stp", options={"HIDDEN"})

    def patch_options(self) -> PatchOptions:
        return replace(super().patch_options(), force=self.force)

    @refusing
    def begin(self, context: Context) -> Answer:
        return self.start(context, self._prepared(context))

    def shown(self, _context: Context) -> Iterable[str]:
        return StepSettings.__annotations__ | PatchSettings.__annotations__

    def finish(self, context: Context, jobs: list[Any]) -> None:
        faulty = refused(jobs)
        for job in jobs:
            job.note_defects(context)
            self.tell(job)
        if faulty:
            names = ", ".join(job.name for job in faulty)
            raise JobError(
                f"Smooth the faces that Check lists in the panel of the source, or use Write Faulty Faces. "
                f"Nothing was written: the surface of {names} folds or turns too sharply for patches."
            )
        scale = scale_to(self.unit, context.scene)
        with written(self.filepath) as path:
            write_jobs(path, jobs, self.unit, scale)
        self.report({"INFO"}, summary(jobs, self.unit, scale))


class OBJECT_OT_fairing_show_patches(_Fitting, bpy.types.Operator):
    """Show the spline patches of the export as a NURBS surface beside this one"""

    bl_idname = "object.fairing_show_patches"
    bl_label = "Show Patches"
    bl_options = {"UNDO"}

    @refusing
    def begin(self, context: Context) -> Answer:
        jobs = self._prepared(context)
        if modal.predicted_seconds(jobs) > prediction.PATIENCE:
            return self.start(context, jobs)
        return self._block(context, jobs)

    def after(self, context: Context, jobs: Any) -> None:
        for job in jobs:
            job.note_defects(context)
        fitted = [job for job in jobs if not job.refused]
        if fitted:
            self.report({"INFO"}, summary(fitted, "MM", scale_to("MM", context.scene)))
