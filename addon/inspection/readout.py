# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers before and after, of control mesh and surface, stored with the object."""

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import core, memory
from ..blender import Context, Object, Scene
from ..mesh import mesh_changes
from ..mesh.read import control_mesh, read_mesh
from ..mesh.world_shape import world_shape
from ..units import curvature_text, length_text
from .measures import largest_deviation, measure

# (label, key, format: a string, or a function that knows the scene's units)
ROWS: tuple[tuple[str, str, str | Callable[[Scene, float], str]], ...] = (
    ("Total curvature", "total_curvature", "{:.4g}"),  # without a unit
    ("Largest curvature", "largest_curvature", curvature_text),
    ("98 % lie below", "curvature_98", curvature_text),
    ("Worst fold", "worst_fold", "{:.2f}°"),
    ("With sharp edges", "worst_fold_with_sharp", "{:.2f}°"),
    ("Off vertices", "deviation", length_text),
    ("Steps", "steps", "{}"),
    ("Left to gain", "left", "{:.2g} %"),
    ("Faces", "faces", "{:,}"),
)
_FORMS = {key: form for _, key, form in ROWS}
# shown if there is a column Before
NO_SURFACE = "Before is the control mesh: too coarse for curvature, and its folds are those between flat faces."
_OF_SURFACES = {"total_curvature", "largest_curvature", "curvature_98"}


def take(context: Context, target: Object, source: Object | None = None) -> dict[str, Any]:
    """Measures `target` and, if given, the mesh object `source` that it was made from; stores and
    returns both.

    {"after": numbers, "before": numbers or None}; see measures.measure, with `deviation` if known, and
    the core's report: steps, and the possible gain of another step, in percent.
    """
    after, positions = _measured(context, target)
    before = None
    report = memory.recall(target, "report") or {}
    last = core.last_decrement(report)
    left = None if last is None else 100.0 * last**2
    after |= {"steps": core.step_count(report), "left": left}
    if source is not None:
        before, control = _measured(context, source)
        # on few vertices the measured curvature is always too small
        before |= dict.fromkeys(_OF_SURFACES)
        shape = world_shape(target)
        after["deviation"] = largest_deviation(shape.of(control), shape.of(positions))
    record = {"after": after, "before": before, "counts": mesh_changes.watch(context, target.data)}
    memory.keep(target, "readout", record)
    return record


def is_stale(target: Object, record: dict[str, Any]) -> bool:
    """Whether the mesh of `target` has changed since `record` was made."""
    return mesh_changes.is_stale(target.data, record["counts"])


def table(record: dict[str, Any], scene: Scene) -> list[tuple[str, str, str]]:
    """Rows (label, before, after) of texts, without unknown values."""
    before = dict(record["before"] or {}) | dict.fromkeys(_OF_SURFACES)  # older files have these
    rows = [
        (label, text(before, key, scene), text(record["after"], key, scene))
        for label, key, _ in ROWS
    ]
    return [row for row in rows if row[1] or row[2]]


def _measured(context: Context, target: Object) -> tuple[dict[str, Any], np.ndarray]:
    with control_mesh(context, target) as mesh:
        arrays = read_mesh(mesh)
    return measure(world_shape(target).of_arrays(arrays)), arrays.positions


def text(figures: dict[str, Any], key: str, scene: Scene) -> str:
    """The text of one of the ROWS; empty if unknown."""
    value, form = figures.get(key), _FORMS[key]
    if value is None:
        return ""
    return form.format(value) if isinstance(form, str) else form(scene, value)
