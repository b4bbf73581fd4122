# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as a run has read it: how long that takes, and whether what was computed still fits, once it is over."""

from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np

from .. import core, prediction
from ..blender import Context, Object
from .object import Reference
from .read import control_mesh, read_mesh
from .world_shape import WorldShape, world_shape


@dataclass(frozen=True)
class Begun:
    """What a run began with. A long one leaves time for edits, undo and other modes."""

    again: str  # what to do once more, as "Fill"
    name: str
    arrays: core.ControlArrays
    reference: Reference
    mode: str
    shape: WorldShape

    @classmethod
    def of(cls, again: str, target: Object, arrays: core.ControlArrays) -> "Begun":
        reference, shape = Reference(target), world_shape(target)
        return cls(again, target.name, arrays, reference, target.mode, shape)

    def why_outdated(self, context: Context) -> str:
        """Why what was computed does not fit any more, in one sentence; empty if it does."""
        target = self.reference.find()
        if target is None:
            return self._text("was deleted or undone")
        if target.mode != self.mode:
            return self._text("changed its mode")
        with control_mesh(context, target) as mesh:
            now = read_mesh(mesh)
        if (
            core.same_faces(now, self.arrays)
            and np.array_equal(now.positions, self.arrays.positions)
            and self.shape == world_shape(target)
        ):
            return ""
        return self._text("was edited")

    def _text(self, happened: str) -> str:
        return f"{self.again} once more: {self.name} {happened} during the run, and nothing else has changed."


class TimedRun:
    """What runs on the mesh of one object share; they read when they are made."""

    kind: str  # for predictions: an energy, or what is done
    name: str  # what sentences call it
    reference: Reference
    triangles: int
    result: Any = None
    _begun: Begun
    _taken = 0.0

    @property
    def _key(self) -> tuple[str, Any]:
        """For predictions: each kind of run knows a mesh by itself."""
        return type(self).__name__, self.reference.key

    @property
    def predicted_seconds(self) -> float:
        """How long `compute` will take."""
        return prediction.seconds(self.kind, self._work(), self._key)

    def _work(self) -> int:
        """Triangles of all that is computed."""
        return self.triangles

    def compute(self, **watchers: Any) -> None:
        """Runs the core, on any thread; `watchers` are its `monitor` and `progress`. Raises JobError."""
        begun = perf_counter()
        self._compute(watchers)
        self._taken = perf_counter() - begun

    def _compute(self, watchers: dict[str, Any]) -> None:
        raise NotImplementedError

    def why_outdated(self, context: Context) -> str:
        """Why what was computed does not fit any more, in one sentence; empty if it does."""
        return self._begun.why_outdated(context)

    def note(self) -> None:
        """For predictions, on the main thread."""
        prediction.note(self.kind, self._work(), self._taken, self._key)
