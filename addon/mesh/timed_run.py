# SPDX-License-Identifier: GPL-3.0-or-later
"""A run on one object's mesh: its predicted time, and whether its result still applies."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import Any

import numpy as np

from .. import core, prediction
from ..blender import Context, Mesh, Object
from .object import Reference
from .read import control_mesh, read_mesh
from .world_shape import WorldShape, world_shape


class TimedRun:
    """The common part of all runs, which read the mesh in their constructors."""

    kind: str  # for predictions: an energy, or another kind of work
    again: str  # verb for repeating it if the mesh has changed meanwhile, such as "Fill"
    name: str  # for sentences
    reference: Reference
    shape: WorldShape
    arrays: core.ControlArrays
    triangles: int
    result: Any = None
    taken = 0.0  # seconds

    @contextmanager
    def _reading(self, context: Context, target: Object, evaluated: bool = False) -> Iterator[Mesh]:
        """Stores the object and the mesh of the run; yields the mesh that `control_mesh` yields."""
        self.name, self.reference = target.name, Reference(target)
        self.shape, self._mode = world_shape(target), target.mode
        with control_mesh(context, target, evaluated) as mesh:
            self.arrays = read_mesh(mesh)
            yield mesh

    @property
    def _key(self) -> tuple[str, Any]:
        """The key for predictions: each kind of run has its own for a mesh."""
        return type(self).__name__, self.reference.key

    @property
    def predicted_seconds(self) -> float:
        return prediction.seconds(self.kind, self._work(), self._key)

    def _work(self) -> int:
        """Number of triangles that are computed."""
        return self.triangles

    def compute(self, **watchers: Any) -> None:
        """Runs the core, on any thread; `watchers` are its `monitor` and `progress`. Raises JobError."""
        begun = perf_counter()
        self._compute(watchers)
        self.taken = perf_counter() - begun

    def _compute(self, watchers: dict[str, Any]) -> None:
        raise NotImplementedError

    def why_outdated(self, context: Context) -> str:
        """Why the result no longer applies, after edits, undo or another mode; else empty."""
        happened = self._what_happened(context)
        if not happened:
            return ""
        return f"{self.again} once more: {self.name} {happened} during the run, and nothing else has changed."

    def _what_happened(self, context: Context) -> str:
        target = self.reference.find()
        if target is None:
            return "was deleted or undone"
        if target.mode != self._mode:
            return "changed its mode"
        with control_mesh(context, target) as mesh:
            now = read_mesh(mesh)
        same = now.has_faces_of(self.arrays) and self.shape == world_shape(target)
        same = same and np.array_equal(now.positions, self.arrays.positions)
        return "" if same else "was edited"

    def note(self) -> None:
        """Records the time for predictions, on the main thread."""
        prediction.note(self.kind, self._work(), self.taken, self._key)
