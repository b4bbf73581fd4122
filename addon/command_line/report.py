# SPDX-License-Identifier: GPL-3.0-or-later
"""What a call did: a table for people, JSON for programs."""

import json
from math import isfinite, nan

from ..inspection import convergence

SCHEMA = 1

DONE, FAILED, CANCELLED, NOT_RUN = "done", "failed", "cancelled", "not_run"


def new_record(place, settings):
    """One input's entry, as if its turn never came. `settings`: a dict."""
    return {
        "input": str(place.source),
        "output": str(place.target),
        "status": NOT_RUN,
        "error": None,
        "warnings": [],
        "seconds": 0.0,
        "settings": settings,
        "objects": [],
    }


def error_entry(code, message, elements=()):
    return {"code": code, "message": message, "elements": [int(element) for element in elements]}


def document(versions, exit_code, records):
    """The whole report as JSON text, without the NaN that JSON does not know."""
    whole = {"schema": SCHEMA, **versions, "exit_code": exit_code, "inputs": records}
    return json.dumps(_finite(whole), indent=2, allow_nan=False, default=str) + "\n"


def table_head(width, energy):
    """`energy`: a setting's identifier, which decides how accuracy is said."""
    accuracy = f"{'residual':>9}" if energy == "THIN_PLATE" else f"{'steps':>6} {'decrement':>9}"
    return f"{'file':<{width}} {'faces in':>10} {'faces out':>11} {'seconds':>8} {'energy before → after':>25} {accuracy}"


def table_line(record, width):
    """A finished input's line: sums over its objects, and the accuracy of the worst one."""
    objects = record["objects"]
    faces_in, faces_out = (sum(item[side]["faces"] for item in objects) for side in ("control", "result"))
    before, after = (
        sum(_energy(item["report"], record, state) for item in objects) for state in ("polyhedron", "result")
    )
    energies = f"{before:.4g} → {after:.4g}"
    return (
        f"{record['input']:<{width}} {faces_in:>10,} {faces_out:>11,} {record['seconds']:>8.2f} "
        f"{energies:>25} {_accuracy([item['report'] for item in objects], record['settings']['energy'])}"
    )


def _accuracy(reports, energy):
    if energy == "THIN_PLATE":
        return f"{max(report.get('residuals', [nan])[-1] for report in reports):>9.1e}"
    most_steps = max(convergence.steps(report) or 0 for report in reports)
    decrement = max(convergence.decrement(report) or 0.0 for report in reports)
    return f"{most_steps:>6} {decrement:>9.1e}"


def _energy(report, record, state):
    # before and after are told for two energies; the third makes little of the total curvature too
    told = "thin_plate" if record["settings"]["energy"] == "THIN_PLATE" else "total_curvature"
    return report.get("energy", {}).get(state, {}).get(told, nan)


def _finite(value):
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not isfinite(value) else value
