# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers before and after: of the control mesh and of what became of it.

Kept with the object.
"""

from typing import Any

import numpy as np

from .. import core, memory
from ..blender import Context, Object
from ..mesh import mesh_changes
from ..mesh.read import control_mesh, read_mesh
from .measures import largest_deviation, measure

# (label, key, how to write it). Curvature is one over a length: no unit fits all scenes, so none is
# shown
ROWS = (
    ("Total curvature", "total_curvature", "{:.4g}"),
    ("Largest curvature", "largest_curvature", "{:.3g}"),
    ("98 % lie below", "curvature_98", "{:.3g}"),
    ("Worst fold", "worst_fold", "{:.2f}°"),
    ("… sharp ones too", "worst_fold_with_sharp", "{:.2f}°"),
    ("Off the vertices", "deviation", "{:.3g}"),
    ("Steps", "steps", "{}"),
    ("Last decrement", "decrement", "{:.1e}"),
    ("Faces", "faces", "{:,}"),
)
_FORMS = {key: form for _, key, form in ROWS}
# said wherever there is a column Before
NO_SURFACE = (
    "Before is the control mesh. Its few vertices are no surface: they say nothing of curvature, "
    "and its folds are those between flat faces."
)
_OF_SURFACES = {"total_curvature", "largest_curvature", "curvature_98"}


def take(context: Context, target: Object, source: Object | None = None) -> dict[str, Any]:
    """Measures `target` and, if there is one, the mesh object `source` that it was made from;
    remembers and returns both.

    {"after": numbers, "before": numbers or None}; see measures.measure, with `deviation` where
    known, and what the core has reported: steps and their last decrement.
    """
    after, positions = _measured(context, target)
    before = None
    report = memory.recall(target, "report") or {}
    after |= {"steps": core.step_count(report), "decrement": core.last_decrement(report)}
    if source is not None:
        before, control = _measured(context, source)
        # on its few vertices a coarse mesh always looks calmer than it is
        before |= dict.fromkeys(_OF_SURFACES)
        after["deviation"] = largest_deviation(control, positions)
    record = {"after": after, "before": before, "counts": mesh_changes.watch(context, target.data)}
    memory.keep(target, "readout", record)
    return record


def is_stale(target: Object, record: dict[str, Any]) -> bool:
    """Whether the mesh of `target` was changed since `record` was taken."""
    return mesh_changes.is_stale(target.data, record["counts"])


def table(record: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Rows (label, before, after) of texts; lines that nobody knows anything about are left out."""
    before = dict(record["before"] or {}) | dict.fromkeys(_OF_SURFACES)  # older files have them
    rows = [(label, text(before, key), text(record["after"], key)) for label, key, _ in ROWS]
    return [row for row in rows if row[1] or row[2]]


def _measured(context: Context, target: Object) -> tuple[dict[str, Any], np.ndarray]:
    with control_mesh(context, target) as mesh:
        arrays = read_mesh(mesh)
    return measure(arrays), arrays.positions


def text(figures: dict[str, Any], key: str) -> str:
    """One of the ROWS as it is shown; empty where nobody knows it."""
    value = figures.get(key)
    return "" if value is None else _FORMS[key].format(value)
