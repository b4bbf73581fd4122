# SPDX-License-Identifier: GPL-3.0-or-later
"""The joints between objects whose borders meet, worst first. Not stored in files."""

from dataclasses import dataclass
from itertools import permutations
from math import degrees

import numpy as np

from .. import core
from ..blender import Context
from ..mesh.object import Reference
from ..mesh.read import source_objects
from ..surfaces.neighbours import shown


@dataclass(frozen=True)
class Row:
    """One joint of two objects: its largest gap (scene units), kink (radians) and jump (a share of the
    largest curvature across it); `worst`: the vertex of the first object with that kink.
    """

    first: Reference
    names: tuple[str, str]
    gap: float
    kink: float
    jump: float
    worst: int

    def text(self) -> str:
        return f"{self.names[0]} and {self.names[1]}: kink {degrees(self.kink):.2f}°, curvature {100 * self.jump:.0f} %"


_SINGLE = float(np.finfo(np.float32).eps)  # of a coordinate: smaller gaps are its rounding
_rows: list[Row] = []


def rows() -> list[Row]:
    """The result of the last `measure`, without deleted objects."""
    return [row for row in _rows if row.first.find() is not None]


def measure(context: Context) -> list[Row]:
    """Measures all pairs of selected objects whose borders meet, as shown in the window."""
    objects = source_objects(context)
    meshes = [shown(context, target) for target in objects]
    found: dict[tuple[int, int], Row] = {}
    for a, b in permutations(range(len(objects)), 2):
        joint = core.module().joint(meshes[a], meshes[b])
        known = found.get((b, a))
        if not len(joint.vertex) or (known is not None and known.kink >= joint.kink.max()):
            continue
        found.pop((b, a), None)
        gap = float(joint.gap.max())
        found[a, b] = Row(
            Reference(objects[a]),
            (objects[a].name, objects[b].name),
            gap if gap > _SINGLE * np.abs(meshes[a][0]).max() else 0.0,
            float(joint.kink.max()),
            float(joint.jump.max()),
            int(joint.vertex[np.argmax(joint.kink)]),
        )
    _rows[:] = sorted(found.values(), key=lambda row: -row.kink)
    return rows()
