# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare: the surfaces of all energies in a row beside their source, measured."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import bpy
import numpy as np

from ..blender import Context, Object
from ..choices import ENERGIES
from ..inspection import readout
from ..job import Job
from ..memory import active_source
from ..poll import needs
from ..settings import Settings
from ..ui.main import active_settings
from .fair import Fairing, can_fair

MEASURED = 250_000  # triangles; larger surfaces are measured on request
_GAP = 1.15  # distance of successive surfaces, in widths of the source


class OBJECT_OT_fairing_compare(Fairing, bpy.types.Operator):
    """Make a surface with each kind of fairness and the settings of the panel, in a row beside this mesh, and measure them"""

    bl_idname = "object.fairing_compare"
    bl_label = "Compare Fairness"

    reasons = (can_fair, needs(active_source, "Select a mesh object first"))

    def make_jobs(self, context: Context) -> list[Job]:
        source = cast(Object, active_source(context))
        settings = Settings.of(active_settings(context))
        return [Job(context, source, replace(settings, energy=e)) for e, *_ in ENERGIES]

    def after(self, context: Context, jobs: Sequence[Job]) -> None:
        source = cast(Object, jobs[0].source)
        source.hide_set(False)
        context.view_layer.update()
        step = _GAP * _width(source)
        for place, (target, (_, name, *_)) in enumerate(zip(self._written, ENERGIES, strict=True)):
            target.name = f"{source.name} {name}"
            target.show_name = True
            moved = target.matrix_world.copy()
            moved.translation.x += (place + 1) * step
            target.matrix_world = moved
        for target in self._written:
            if len(target.data.loops) <= 3 * MEASURED:
                readout.take(context, target, source)


def _width(source: Object) -> float:
    """Width of its bounding box, along the world's X."""
    matrix = np.array(source.matrix_world)
    corners = np.array([tuple(corner) for corner in source.bound_box])
    return float(np.ptp(corners @ matrix[0, :3]))
