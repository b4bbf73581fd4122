# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Hole Fair: fills holes of the mesh itself so that they become invisible. Clean Scan: makes a closed surface of a
raw scan, and lists what was done.
"""

from collections.abc import Iterator, Sequence
from typing import cast

import bpy
from bpy.props import IntVectorProperty

from ..blender import Answer, Context, Object
from ..choices import ENERGIES, FILL_JOINTS
from ..errors import JobError
from ..fields import choice, factor, length, number, switch
from ..jobs.clean import STEPS, CleanJob
from ..jobs.fill import FillOptions, HoleJob, fill_warnings
from ..mesh.read import source_objects
from ..poll import of_meshes
from ..settings import values_of
from ..words import counted
from .fair import InMeshes, WholeFairing, can_fair
from .mixins import Shown


class LargestHole:
    largest: length(
        "Largest Hole",
        "Holes wider than this between two vertices of the rim stay open; 0 fills all but borders of sheets",
    )


class OBJECT_OT_fairing_fill(Shown, LargestHole, WholeFairing, bpy.types.Operator):
    """Fill holes with a fair continuation of the faces around: all small ones, or in Edit Mode the selected ones"""

    bl_idname = "object.fairing_fill"
    bl_label = "Fill Hole Fair"
    cancelled_text = "Filling was cancelled: nothing has changed"

    joint: choice("Joint", "How the filling meets the faces around", FILL_JOINTS, "CURVATURE")
    energy: choice(
        "Fairness",
        "What the filling minimizes: Curvature restores half a sphere",
        ENERGIES,
        "TOTAL_CURVATURE",
    )
    density: number(
        "Density",
        "How many times finer than the rim the filling is; 0: no new vertices",
        1.0,
        min=0.0,
        max=100.0,
        soft_max=4.0,
    )
    noisy: switch(
        "Noisy Rim",
        "For measured faces: reads six rings around the hole, so that their noise does not continue",
    )
    edge: IntVectorProperty(
        name="Edge",
        description="Two vertices of the rim of the one hole of the active object to be filled",
        size=2,
        default=(-1, -1),
        options={"HIDDEN", "SKIP_SAVE"},
    )

    reasons = (can_fair, of_meshes(source_objects))

    def shown(self, context: Context) -> Iterator[str]:
        yield "joint"
        if self.joint == "FLAT":
            return
        if self.joint != "POSITION":
            yield from ("energy", "noisy")
        yield "density"
        if context.mode == "OBJECT" and min(self.edge) < 0:
            yield "largest"

    def invoke(self, context: Context, event: bpy.types.Event) -> Answer:
        """From a button: caps and transoms are flat unless another Joint is chosen."""
        self._asked = self.properties.is_property_set("joint")
        return super().invoke(context, event)

    def make_jobs(self, context: Context) -> list[HoleJob]:
        replaces = bool(context.tool_settings.mesh_select_mode[2])
        named = (self.edge[0], self.edge[1]) if min(self.edge) >= 0 else None
        targets = (
            source_objects(context) if named is None else [cast(Object, context.active_object)]
        )
        options = values_of(FillOptions, self, replaces=replaces, edge=named)
        jobs: list[HoleJob] = []
        self._reasons: list[str] = []
        for target in targets:
            try:
                jobs.append(HoleJob(context, target, options))
            except JobError as error:
                self._reasons.append(str(error))
        if not jobs:
            raise JobError(" ".join(self._reasons))
        if not getattr(self, "_asked", True) and all(job.closes_caps for job in jobs):
            self.joint = "FLAT"
            for job in jobs:
                job.flatten()
        return jobs

    def finish(self, context: Context, jobs: Sequence[HoleJob]) -> None:
        """Changes the meshes that can be filled, and reports why others cannot."""
        why = [(job, str(job.error or job.why_outdated(context))) for job in jobs]
        ready = [job for job, reason in why if not reason]
        reasons = [*self._reasons, *(reason for _, reason in why if reason)]
        if ready and context.mode == "EDIT_MESH":  # then only new faces become selected
            bpy.ops.mesh.select_all(action="DESELECT")
        for job in ready:
            job.apply()
        for job in jobs:
            job.check_again(context)
        if not ready:
            raise JobError(" ".join(reasons))
        reasons += [f"{job.name}: {job.left_text}" for job in ready if job.left_text]
        self.report({"INFO"}, _said(ready))
        for sentence in reasons + fill_warnings(ready):
            self.report({"WARNING"}, sentence)


def _said(done: list[HoleJob]) -> str:
    holes = [hole for job in done for hole in job.result.holes]
    cut = sum(len(job.result.cuts) for job in done)
    faces = sum(len(hole.faces) for hole in holes)
    said = [f"{counted(len(holes), 'hole')} filled with {faces:,} faces"] * bool(holes or not cut)
    if cut:
        said.append(counted(cut, "{edge cut at a vertex on it|edges cut at vertices on them}"))
    return ", ".join(said)


class OBJECT_OT_fairing_clean(Shown, LargestHole, InMeshes, bpy.types.Operator):
    """Make a closed surface of a scan: remove loose parts, mend defects, fill holes, and list what was done"""

    bl_idname = "object.fairing_clean"
    bl_label = "Clean Scan"
    cancelled_text = "Cleaning was cancelled: nothing has changed"

    mend: switch(STEPS[0][1], STEPS[0][2], True)
    join: switch(STEPS[1][1], STEPS[1][2], True)
    fins: switch(STEPS[2][1], STEPS[2][2], True)
    normals: switch(STEPS[3][1], STEPS[3][2], True)
    inner: switch(STEPS[4][1], STEPS[4][2], True)
    pinched: switch(STEPS[5][1], STEPS[5][2], True)
    spikes: switch(STEPS[6][1], STEPS[6][2], True)
    folds: switch(STEPS[7][1], STEPS[7][2], True)
    fill: switch(STEPS[8][1], STEPS[8][2], True)
    noise: switch(STEPS[9][1], STEPS[9][2])
    islands: factor(
        "Islands", "Removes parts whose box has a diagonal below this share of the longest", 0.1
    )
    reasons = (can_fair, of_meshes(source_objects))

    def shown(self, _context: Context) -> Iterator[str]:
        for name, *_ in STEPS:
            yield name
            if name == "join":
                yield "islands"
            if name == "fill" and self.fill:
                yield "largest"

    def make_jobs(self, context: Context) -> list[CleanJob]:
        names = (*(name for name, *_ in STEPS), "islands", "largest")
        options = {name: getattr(self, name) for name in names}
        targets = {target.data: target for target in source_objects(context)}.values()
        return [CleanJob(context, target, options) for target in targets]

    def write(self, context: Context, jobs: Sequence[CleanJob]) -> None:
        for job in jobs:
            said = job.apply(context)
            for sentence in said[:-1]:
                self.report({"INFO"}, f"{job.name}: {sentence}")
            good = job.result.watertight and not job.result.left
            self.report({"INFO" if good else "WARNING"}, f"{job.name}: {said[-1]}")
