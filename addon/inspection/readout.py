# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers before and after: of the control mesh and of what became of it. Kept as JSON in a custom property."""

import json

from ..read.mesh import read_mesh
from ..read.source import control_mesh
from . import convergence, freshness
from .measures import largest_deviation, measure

KEY = "fairing_readout"
REPORT = "fairing_report"  # where fairing leaves the core's report

# (label, key, how to write it). Curvature is one over a length: no unit fits all scenes, so none is shown
ROWS = (
    ("Bending energy", "thin_plate", "{:.4g}"),
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


def take(context, target, source=None):
    """Measures `target` and, if there is one, the mesh object `source` that it was made from; remembers and returns both.

    {"after": numbers, "before": numbers or None}; see measures.measure, with `thin_plate` and `deviation` where known, and what the core has reported: total curvature, steps and their last decrement.
    """
    after, positions = _measured(context, target)
    before = None
    report = _report(target)
    energy = report.get("energy", {})
    _take_energies(after, energy.get("result", {}))
    after |= {"steps": convergence.steps(report), "decrement": convergence.decrement(report)}
    if source is not None:
        before, control = _measured(context, source)
        _take_energies(before, energy.get("polyhedron", {}))
        after["deviation"] = largest_deviation(control, positions)
    record = {"after": after, "before": before, "counts": freshness.watch(context, target.data)}
    target[KEY] = json.dumps(record)
    return record


def recall(target):
    """What `take` remembered of `target`, or None."""
    text = target.get(KEY)
    return json.loads(text) if isinstance(text, str) else None


def is_stale(target, record):
    """Whether the mesh of `target` was changed since `record` was taken."""
    return freshness.is_stale(target.data, record["counts"])


def table(record):
    """Rows (label, before, after) of texts; lines that nobody knows anything about are left out."""
    before, after = record["before"] or {}, record["after"]
    rows = [(label, _text(before.get(key), form), _text(after.get(key), form)) for label, key, form in ROWS]
    return [row for row in rows if row[1] or row[2]]


def source_of(target):
    """The mesh object that `target` was faired from, or None."""
    memory = getattr(target, "discrete_fairing", None)
    source = getattr(memory, "source", None)
    return source if source is not None and source.type == "MESH" and source != target else None


def _measured(context, target):
    with control_mesh(context, target) as mesh:
        arrays = read_mesh(mesh)
    return measure(arrays), arrays.positions


def _report(target):
    """The core's, an empty dict if there is none, or none that can be read."""
    try:
        report = json.loads(target[REPORT])
    except (KeyError, TypeError, ValueError):
        return {}
    return report if isinstance(report, dict) else {}


def _take_energies(numbers, reported):
    """The core's own energies, where it has reported them: it measures the control mesh as finely as the surface.

    Measured on its few vertices a coarse mesh always looks calmer than it is.
    """
    for key in ("thin_plate", "total_curvature"):
        value = _finite(reported.get(key))
        if value is not None:
            numbers[key] = value


def _finite(value):
    return value if isinstance(value, (int, float)) and abs(value) < float("inf") else None


def _text(value, form):
    return "" if value is None else form.format(value)
