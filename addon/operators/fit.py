# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface on Scan: the fairest surface of a cage near a scan."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import bpy

from ..blender import Context, Object
from ..errors import JobError
from ..fields import whole
from ..jobs.fair import Job
from ..jobs.fit import Fit, FitJob
from ..jobs.scan_cage import LEAST_CAGE_FACES, MadeCage, make_cage
from ..mesh.object import nothing_left_behind
from ..mesh.scans import is_scan, read_scans
from ..poll import in_mode
from ..properties import FitAmount
from ..settings import Settings
from ..ui.layout import amount_names
from ..words import counted
from .fair import WholeFairing, can_fair, hide
from .mixins import Shown


def _selected(context: Context) -> list[Object]:
    return [o for o in context.selected_objects if is_scan(o)]


def _choice_reason(context: Context) -> str:
    selected = _selected(context)
    if not selected:
        return "Select the scan, or the scan first and the cage last"
    if len(selected) == 1 and selected[0].type != "MESH":
        return "Select the cage last: one can be made for a mesh only"
    return ""


def _chosen(context: Context) -> tuple[Object | None, list[Object]]:
    """The cage, None if it is to be made; and the scans. Raises JobError."""
    selected, active = _selected(context), context.active_object
    if len(selected) == 1 or _are_all_scans(context, selected):
        return None, selected
    if active is None or active not in selected or active.type != "MESH":
        raise JobError(
            "Select the scan first and the cage last. The active object is no mesh among those selected."
        )
    return active, [o for o in selected if o != active]


def _are_all_scans(context: Context, selected: list[Object]) -> bool:
    """Whether none of them can be the cage: each has more faces than any other has points."""
    if not all(o.type == "MESH" and len(o.data.polygons) for o in selected):
        return False
    points = [len(read_scans(context, [o]).points) for o in selected]
    return all(
        len(o.data.polygons) > max(points[:k] + points[k + 1 :]) for k, o in enumerate(selected)
    )


class OBJECT_OT_fairing_fit(Shown, WholeFairing, FitAmount, bpy.types.Operator):
    """Make the fairest surface near the selected scans, from the active mesh as cage, or from one that is made where all selected are scans"""

    bl_idname = "object.fairing_fit"
    bl_label = "Fair Surface on Scan"
    cancelled_text = "The fit was cancelled: nothing has changed but a cage that was made"

    levels: whole("Levels", "How often each face of the cage is split into four", 2, min=0, max=6)
    cage_faces: whole(
        "Faces of Cage",
        "Faces of the cage that is made where scans alone are selected; at most one for 25 of its points",
        300,
        min=LEAST_CAGE_FACES,
        max=20000,
        soft_max=2000,
    )

    reasons = (
        can_fair,
        in_mode("Go to Object Mode first", "OBJECT"),
        _choice_reason,
    )

    def shown(self, _context: Context) -> Iterable[str]:
        return ("levels", *amount_names(self), "cage_faces")

    def make_jobs(self, context: Context) -> list[Job]:
        with nothing_left_behind():  # such as a cage over a scan that is refused then
            return [self._job(context)]

    def _job(self, context: Context) -> Job:
        cage, scans = _chosen(context)
        scan = read_scans(context, scans)
        note = ""
        if cage is None:
            made = make_cage(context, scans, self.cage_faces)
            cage, note = made.object, self._note_of(made)
        elif 0 < len(scan.points) < len(cage.data.polygons):
            raise JobError(
                f"{cage.name}: Select the scan first and the cage last, or make the cage coarser. It has"
                f" {counted(len(cage.data.polygons), 'face')}, and the scan {counted(len(scan.points), 'point')} only."
            )
        settings = replace(Settings.of(context.scene.discrete_fairing), levels=self.levels)
        tolerance = self.tolerance if self.amount == "TOLERANCE" else None
        fit = Fit(scan, tolerance, objects=scans)
        job = FitJob(context, cage, fit, settings)
        if note:
            job.notes.append(note)
        return job

    def after(self, context: Context, jobs: Sequence[FitJob]) -> None:
        """Hides scans and cage, which lie in the surface, among its points."""
        for job in jobs:
            for target in job.made_from if job.settings.hide_source else ():
                hide(context, target)

    def _note_of(self, made: MadeCage) -> str:
        """What a cage that was made leaves out, or why it has another number of faces than was asked for."""
        faces = counted(len(made.object.data.polygons), "face")
        if not made.is_whole:
            return f"The cage leaves out a part of the scan: draw one over it. It has {faces}."
        if not made.is_by_quads:
            return f"QuadriFlow made no cage of the whole scan: this one has triangles, {faces} in all."
        if made.is_limited:
            return f"The scan has few points: its cage has {faces}, and not more."
        if made.is_finer:
            return f"With {self.cage_faces} faces the cage left out a part of the scan: it has {faces}."
        return ""
