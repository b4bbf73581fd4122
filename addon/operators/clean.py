# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean Scan: makes a closed surface of a raw scan, and lists what was done."""

from collections.abc import Iterator, Sequence

import bpy

from ..blender import Context
from ..fields import factor, switch
from ..jobs.clean import STEPS, CleanJob, CleanOptions
from ..mesh.read import source_objects
from ..poll import of_meshes
from .fair import InMeshes, can_fair
from .fill_holes import LargestHole
from .mixins import Shown


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
        steps = {name: bool(getattr(self, name)) for name, *_ in STEPS}
        options = CleanOptions(steps, self.islands, self.largest)
        targets = {target.data: target for target in source_objects(context)}.values()
        return [CleanJob(context, target, options) for target in targets]

    def write(self, context: Context, jobs: Sequence[CleanJob]) -> None:
        for job in jobs:
            said = job.apply(context)
            for sentence in said[:-1]:
                self.report({"INFO"}, f"{job.name}: {sentence}")
            good = job.result.watertight and not job.result.left
            self.report({"INFO" if good else "WARNING"}, f"{job.name}: {said[-1]}")
