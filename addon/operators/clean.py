# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean Scan: makes a closed surface of a raw scan, and lists what was done."""

from collections.abc import Iterator, Sequence

import bpy
from bpy.props import BoolProperty, FloatProperty

from ..blender import Context
from ..cleaning import STEPS, CleanJob, CleanOptions
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

    mend: BoolProperty(name=STEPS[0][1], description=STEPS[0][2], default=True)
    join: BoolProperty(name=STEPS[1][1], description=STEPS[1][2], default=True)
    fins: BoolProperty(name=STEPS[2][1], description=STEPS[2][2], default=True)
    normals: BoolProperty(name=STEPS[3][1], description=STEPS[3][2], default=True)
    inner: BoolProperty(name=STEPS[4][1], description=STEPS[4][2], default=True)
    pinched: BoolProperty(name=STEPS[5][1], description=STEPS[5][2], default=True)
    spikes: BoolProperty(name=STEPS[6][1], description=STEPS[6][2], default=True)
    folds: BoolProperty(name=STEPS[7][1], description=STEPS[7][2], default=True)
    fill: BoolProperty(name=STEPS[8][1], description=STEPS[8][2], default=True)
    noise: BoolProperty(name=STEPS[9][1], description=STEPS[9][2], default=False)
    islands: FloatProperty(
        name="Islands",
        description="Removes parts whose box has a diagonal below this share of the longest",
        default=0.1,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
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
