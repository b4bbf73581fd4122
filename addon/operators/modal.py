# SPDX-License-Identifier: GPL-3.0-or-later
"""Long runs in a window: the view stays responsive, the status bar shows the progress, ESC cancels.

Adjust Last Operation never blocks for long: if the whole surface takes too long, it makes one with fewer levels.
Blender calls `execute` there, which can neither be modal nor be cancelled.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import bpy

from .. import core, prediction
from ..blender import Answer, Context, OperatorBase, current_context
from ..errors import JobError
from ..jobs.fair import Job
from ..live.full_level import is_dragging
from ..mesh.object import session_key
from ..mesh.timed_run import TimedRun
from ..poll import needs
from ..queue import Queue, running, set_running, status_text
from ..redraw import Progress, tag_sidebars
from ..settings import Settings
from .mixins import Action, refusing

_INTERVAL = 0.05  # seconds between two checks of the thread


class ModalRun(OperatorBase):
    """Mix-in that computes jobs on a thread and calls `finish(context, jobs)` after all."""

    cancelled_text = "Fairing was cancelled: nothing has changed"

    def finish(self, context: Context, jobs: list[Job]) -> None:
        raise NotImplementedError

    def start(self, context: Context, jobs: list[Job]) -> Answer:
        """Starts the run; the operator returns the result of this."""
        self._jobs = jobs
        self._queue = Queue(jobs, core.module().Monitor)
        set_running(self._queue)
        self._progress = Progress()
        self._told: set[int] = set()  # the workspaces whose status bars show the progress
        manager = context.window_manager
        self._timer = manager.event_timer_add(_INTERVAL, window=context.window)
        manager.modal_handler_add(self)
        self._queue.start()
        return {"RUNNING_MODAL"}

    def modal(self, context: Context, event: bpy.types.Event) -> Answer:
        """Consumes no event but ESC."""
        if event.type == "ESC" and event.value == "PRESS":
            self._queue.cancel()
            return {"RUNNING_MODAL"}
        if event.type == "TIMER":
            # while something is dragged, `finish` must not remove it
            if self._queue.finished and not is_dragging(context):
                return self._end(context)
            text = status_text(self._queue) + "     ESC: Cancel"
            if self._progress.is_due(text):
                self._show(context, text)
        return {"PASS_THROUGH"}

    def cancel(self, context: Context) -> None:
        """Called by Blender when it ends the operator itself, such as on quitting."""
        self._queue.cancel()
        self._clean_up(context)

    @refusing
    def _end(self, context: Context) -> Answer:
        queue = self._queue
        self._clean_up(context)
        if queue.error:
            raise JobError(queue.error)
        if queue.cancelled:
            self.report({"INFO"}, self.cancelled_text)
            return {"CANCELLED"}
        self.finish(context, self._jobs)
        return {"FINISHED"}

    def _clean_up(self, context: Context) -> None:
        self._queue.join()
        if running() is self._queue:
            set_running(None)
        context.window_manager.event_timer_remove(self._timer)
        self._show(context, None)

    def _show(self, context: Context, text: str | None) -> None:
        """Updates status bars and sidebars, not slow viewports; None restores Blender's text."""
        if text is not None:
            seen = {session_key(w.workspace): w.workspace for w in context.window_manager.windows}
        else:  # other workspaces may have been visible meanwhile
            seen = {session_key(w): w for w in bpy.data.workspaces}
            seen = {key: seen[key] for key in self._told & seen.keys()}
        for workspace in seen.values():
            workspace.status_text_set(text)
        self._told |= seen.keys()
        tag_sidebars(context)


class OBJECT_OT_fairing_cancel(Action, bpy.types.Operator):
    """End the present run, as ESC does, and change nothing"""

    bl_idname = "object.fairing_cancel"
    bl_label = "Cancel"
    bl_options = {"INTERNAL"}

    reasons = (needs(lambda _: running(), "Nothing to cancel: no surface is being faired"),)

    def act(self, _context: Context) -> None:
        if (queue := running()) is not None:
            queue.cancel()


BUDGET = 0.5 * prediction.PATIENCE  # for computing; reading, writing and undo also take time
_WITHOUT = "THIN_PLATE"  # replaces an energy that is too slow even for a small surface


def predicted_seconds(jobs: Sequence[TimedRun]) -> float:
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
