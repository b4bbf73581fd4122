# SPDX-License-Identifier: GPL-3.0-or-later
"""Long runs in a window: the view stays alive, the panel and the status bar show how far it is, ESC ends it."""

from .. import native
from .progress import phase_text
from .queue import Queue

# what may still be done to the view meanwhile
_NAVIGATION = {
    "MIDDLEMOUSE",
    "WHEELUPMOUSE",
    "WHEELDOWNMOUSE",
    "WHEELINMOUSE",
    "WHEELOUTMOUSE",
    "TRACKPADPAN",
    "TRACKPADZOOM",
    "NDOF_MOTION",
}
_INTERVAL = 0.05  # seconds between two looks at the thread

_running = None  # the queue in progress


def running():
    """The Queue in progress, or None."""
    return _running


def status_text(queue):
    """`Suzanne (2 of 5): Fairing, 45 %`."""
    position, count = queue.position
    which = f" ({position} of {count})" if count > 1 else ""
    doing = "Cancelling" if queue.cancelled else phase_text(queue.phase)
    return f"{queue.job_name}{which}: {doing}, {100 * queue.fraction:.0f} %"


class ModalRun:
    """Mix-in of an operator that computes jobs on a thread and calls `finish(context, jobs)` when all are done."""

    def start(self, context, jobs):
        """Begins; the operator returns what this returns."""
        global _running
        self._queue = _running = Queue(jobs, native.core().Monitor)
        manager = context.window_manager
        self._timer = manager.event_timer_add(_INTERVAL, window=context.window)
        manager.modal_handler_add(self)
        self._queue.start()
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self._queue.cancel()
        if event.type == "TIMER":
            if self._queue.finished:
                return self._end(context)
            self._show(context, status_text(self._queue) + "     ESC: Cancel")
        return {"PASS_THROUGH"} if event.type in _NAVIGATION else {"RUNNING_MODAL"}

    def cancel(self, context):
        """Called by Blender when it ends the operator itself, as on quitting."""
        self._queue.cancel()
        self._clean_up(context)

    def _end(self, context):
        queue = self._queue
        self._clean_up(context)
        if queue.error:
            self.report({"ERROR"}, queue.error)
        elif queue.cancelled:
            self.report({"INFO"}, "Fairing was cancelled: nothing has changed")
        else:
            return self.finish(context, queue.jobs)
        return {"CANCELLED"}

    def _clean_up(self, context):
        global _running
        self._queue.join()
        _running = None
        context.window_manager.event_timer_remove(self._timer)
        self._show(context, None)

    @staticmethod
    def _show(context, text):
        """Status bar and panels; None puts back what Blender shows there itself."""
        context.workspace.status_text_set(text)
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    area.tag_redraw()
