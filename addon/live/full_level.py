# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface at all its levels, once edits pause: computed on a thread, so that the next edit can begin."""

from .. import native
from ..check import messages
from ..run.job import Job
from ..run.job_error import JobCancelled, JobError
from ..run.progress import phase_text
from ..run.queue import Queue

PAUSE = 0.3  # seconds without an edit
_EDITING = (
    "TRANSFORM_OT_",
    "MESH_OT_",
    "SCULPT_OT_",
    "VIEW3D_OT_edit_mesh_",
)  # modal operators of these are edits


class FreshSolver:
    """A solver about the shape that the mesh has now, with its first surface: what the next edit starts from.

    The one in use keeps the charts of the shape that it was made for, and may be needed meanwhile.
    """

    triangles = 0  # for the bar: little beside the full level

    def __init__(self, name, arguments):
        self.name = name
        self._arguments = arguments
        self.solver = None

    def compute(self, monitor=None):
        core = native.core()
        try:
            solver = core.Solver(**self._arguments)
            solver.solve(monitor=monitor)
        except core.FairingError as error:
            kind = JobCancelled if error.code == "CANCELLED" else JobError
            raise kind(messages.error_text(self.name, error), error.code) from error
        self.solver = solver


class FullLevel:
    """A run of the job that Recompute does, and then of a fresh solver."""

    def __init__(self, context, source, target, region, arguments):
        """Reads; raises JobError. Then `start` or `compute`. `arguments`: of the live solver, for `region` or all faces."""
        self.job = Job(context, source, target.discrete_fairing, target, region)
        self._fresh = FreshSolver(source.name, {**arguments, "vertices": self.job.arrays.positions})
        self._queue = Queue([self.job, self._fresh], native.core().Monitor)

    def start(self):
        """Computes on a thread."""
        self._queue.start()

    def compute(self):
        """The surface alone, at once; raises JobError."""
        self.job.compute()

    @property
    def finished(self):
        return self._queue.finished

    @property
    def solver(self):
        """The fresh solver, None if there is none."""
        return self._fresh.solver

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
