# SPDX-License-Identifier: GPL-3.0-or-later
"""Computes the surface at all its levels on a thread once edits pause; the next edit may begin."""

from time import monotonic
from typing import Any

import numpy as np

from .. import core, errors
from ..blender import Context, Object
from ..jobs.fit import job_of
from ..queue import Queue
from ..settings import Settings

PAUSE = 0.3  # seconds without an edit
# modal operators in these modes are edits
_EDITING = ("TRANSFORM_OT_", "MESH_OT_", "SCULPT_OT_", "VIEW3D_OT_edit_mesh_")


class FreshSolver:
    """A solver for the present shape of the mesh, with its first surface, as the start of the next
    edit.

    The solver in use keeps the charts of the shape it was made for, and may be needed meanwhile.
    """

    triangles = 0  # for the progress bar: negligible beside the full level

    def __init__(self, name: str, arguments: dict[str, Any]) -> None:
        self.name = name
        self._arguments = arguments
        self.solver = None

    def compute(self, **watchers: Any) -> None:
        with errors.explained(self.name):
            solver = core.solver(self._arguments)
            solver.solve(**watchers)
        self.solver = solver


class FullLevel(Queue):
    """A run of the job of Recompute, and then of a fresh solver."""

    def __init__(
        self,
        context: Context,
        source: Object,
        target: Object,
        region: np.ndarray | None,
        arguments: dict[str, Any],
    ) -> None:
        """Reads the mesh; raises JobError. `arguments`: those of the live solver, for `region` or all faces."""
        settings = Settings.of(target.discrete_fairing)
        self.job = job_of(context, source, settings, target, region, again=False)
        now = ("vertices", "tolerance", "weights")
        its = {name: self.job.arguments[name] for name in now if name in self.job.arguments}
        self.arguments = {**arguments, **its}  # arguments of the fresh solver
        self.fresh = FreshSolver(source.name, self.arguments)
        super().__init__([self.job, self.fresh], core.module().Monitor)


class Schedule:
    """Schedules the full level; `run` is the FullLevel in progress, or None."""

    def __init__(self) -> None:
        self._begins: float | None = None
        self.run: FullLevel | None = None

    @property
    def is_planned(self) -> bool:
        return self._begins is not None

    def plan(self) -> None:
        """Plans the run for when edits have paused."""
        self._begins = monotonic() + PAUSE

    def drop(self) -> None:
        self._begins = None

    def is_due(self, context: Context, at_once: bool) -> bool:
        """Whether the run must begin now; `at_once`: without a pause."""
        return (
            self._begins is not None
            and (at_once or monotonic() >= self._begins)
            and not is_editing(context)
        )

    def cancel(self, wait: bool = False) -> None:
        """Cancels a run whose source has changed, and plans the next."""
        if self.run is not None:
            self.run.cancel()
            if wait:
                self.run.join()
            self.run = None
            self.plan()


def is_dragging(context: Context) -> bool:
    """Whether the mouse drags an edited element."""
    return any(
        operator.bl_idname.startswith(_EDITING)
        for window in context.window_manager.windows
        for operator in window.modal_operators
    )


def is_editing(context: Context) -> bool:
    """Whether an edit is in progress: a dragging mouse, or a playing animation."""
    windows = context.window_manager.windows
    return is_dragging(context) or any(w.screen.is_animation_playing for w in windows)
