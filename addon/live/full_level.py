# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface at all its levels, once edits pause: computed on a thread, so that the next edit can begin."""

from .. import native
from ..run.job import Job
from ..run.progress import phase_text
from ..run.queue import Queue

PAUSE = 0.3  # seconds without an edit
_EDITING = (
    "TRANSFORM_OT_",
    "MESH_OT_",
    "SCULPT_OT_",
    "VIEW3D_OT_edit_mesh_",
)  # modal operators of these are edits


class FullLevel:
    """A run of the job that Recompute does."""

    def __init__(self, context, source, target, region):
        """Reads; raises JobError. Then `start` or `compute`."""
        self.job = Job(context, source, target.discrete_fairing, target, region)
        self._queue = Queue([self.job], native.core().Monitor)

    def start(self):
        """Computes on a thread."""
        self._queue.start()

    def compute(self):
        """Computes at once; raises JobError."""
        self.job.compute()

    @property
    def finished(self):
        return self._queue.finished

    @property
    def error(self):
        """Why there is no surface, a sentence; None if there is one."""
        return self._queue.error

    @property
    def text(self):
        """How far it is: `Fairing, 45 %`."""
        return f"{phase_text(self._queue.phase)}, {100 * self._queue.fraction:.0f} %"

    def cancel(self, wait=False):
        self._queue.cancel()
        if wait:
            self._queue.join()


def is_editing(context):
    """Whether an edit is still going on: a mouse that drags, an animation that plays."""
    for window in context.window_manager.windows:
        if window.screen.is_animation_playing:
            return True
        if any(operator.bl_idname.startswith(_EDITING) for operator in window.modal_operators):
            return True
    return False
