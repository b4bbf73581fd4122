# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Compare": the surfaces of one source side by side, in numbers."""

import bpy

from ..blender import Context, Object, Scene, all_objects
from ..choices import ENERGIES, ENERGY_NAMES
from ..inspection import readout
from ..memory import recall, source_of
from .layout import Folded, draw_notice

_HEADS = ("", "Curvature", "Worst fold")
_ORDER = [key for key, *_ in ENERGIES]


class VIEW3D_PT_fairing_compare(Folded, bpy.types.Panel):
    bl_label = "Compare"

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.operator("object.fairing_compare", icon="MOD_ARRAY")
        measured = measured_surfaces(context.active_object)
        if not measured:
            return
        if any(readout.is_stale(o, record) for o, record in measured):
            draw_notice(layout, "A mesh was changed since: select all, press Measure", icon="INFO")
        split = layout.box().split(factor=0.48)
        columns = [split.column(align=True) for _ in _HEADS]
        for row in (_HEADS, *(figures(*pair, context.scene) for pair in measured)):
            for column, text in zip(columns, row, strict=True):
                column.label(text=text)


def measured_surfaces(active: Object | None) -> list[tuple[Object, dict]]:
    """The measured surfaces of the active object, or of its source, with their read-outs."""
    if active is None or active.type != "MESH":
        return []
    source = source_of(active) or active
    made = [o for o in all_objects() if o.type == "MESH" and o.discrete_fairing.source == source]
    records = [(target, recall(target, "readout")) for target in made]
    found = [(target, record) for target, record in records if record is not None]
    return sorted(found, key=lambda pair: _ORDER.index(pair[0].discrete_fairing.energy))


def figures(target: Object, record: dict, scene: Scene) -> tuple[str, str, str]:
    """Fairness, total curvature and worst fold, as texts."""
    after = record["after"]
    curvature, fold = (readout.text(after, key, scene) for key in ("total_curvature", "worst_fold"))
    return ENERGY_NAMES[target.discrete_fairing.energy], curvature, fold
