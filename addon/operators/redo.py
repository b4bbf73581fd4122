# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjust Last Operation never blocks for long: if the whole surface takes too long, it makes one with
fewer levels.

Blender calls `execute` there, which can neither be modal nor be cancelled.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import bpy

from .. import prediction
from ..blender import Context, current_context
from ..jobs.fair import Job
from ..queue import TimedJob, running
from ..settings import Settings

BUDGET = 0.5 * prediction.PATIENCE  # for computing; reading, writing and undo also take time
_WITHOUT = "THIN_PLATE"  # replaces an energy that is too slow even for a small surface


def predicted_seconds(jobs: Sequence[TimedJob]) -> float:
    return sum(job.predicted_seconds for job in jobs)


def small_jobs(context: Context, jobs: Sequence[Job]) -> list[Job]:
    """Jobs in place of `jobs` that are fast enough to wait for; raises JobError."""
    budget = BUDGET / len(jobs)
    return [job.with_settings(context, _small(job, budget)) for job in jobs]


def _small(job: Job, budget: float) -> Settings:
    """Its settings with the number of levels and, if needed, the energy that the `budget` allows."""
    fewest = job.fewest_levels
    for energy, least in ((job.settings.energy, 2), (_WITHOUT, 2), (_WITHOUT, fewest)):
        for levels in range(job.settings.levels, least - 1, -1):
            if job.predict(energy, levels) <= budget:
                return replace(job.settings, levels=levels, energy=energy)
    return replace(job.settings, levels=fewest, energy=_WITHOUT)


def invoke_soon(context: Context, operator: Any, properties: dict[str, Any]) -> None:
    """Calls an operator like its button after the current one, unless a run has started."""
    window = context.window
    if window is None:
        return
    place = list(context.window_manager.windows).index(window)

    def begin() -> None:
        manager = current_context().window_manager
        if place < len(manager.windows) and not running():
            with current_context().temp_override(window=manager.windows[place]):
                operator("INVOKE_DEFAULT", True, **properties)  # with an undo step, like a button

    bpy.app.timers.register(begin, first_interval=0.01)


def repeat_soon(context: Context, operator: Any) -> None:
    """Restarts `operator`, with its properties, in the background: redo cannot wait for it."""
    call = getattr(bpy.ops.object, operator.bl_idname.rpartition("_OT_")[2])
    invoke_soon(context, call, operator.as_keywords())
