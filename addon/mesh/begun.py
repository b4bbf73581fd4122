# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as a run has read it: whether what was computed still fits, once the run is over."""

from dataclasses import dataclass

import numpy as np

from .. import core
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
