# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds against size, 50 K to 3 M triangles: the exponent of n, by a straight line through the
logarithms.

Four ways to grow, triangles and quads each: one control mesh with more levels; at three and at two
levels a larger control mesh. Iterations are reported beside, since they are what a time exponent
over one would come from.
"""

from functools import partial
from typing import Any

import control_meshes
import numpy as np
import runs
import table
import timing

TARGET = 1.05
REPEATS = 3

# (mesh, levels) in growing order, 50 K to 3 M triangles
SERIES = {
    "triangles, by levels": [((control_meshes.sphere, 6), level) for level in (3, 4, 5, 6)],
    "triangles, by mesh, L = 3": [((control_meshes.sphere, m), 3) for m in (6, 12, 25, 48)],
    "triangles, by mesh, L = 2": [((control_meshes.sphere, m), 2) for m in (13, 25, 50, 97)],
    "quads, by levels": [((control_meshes.quad_sphere, 8), level) for level in (3, 4, 5, 6)],
    "quads, by mesh, L = 3": [((control_meshes.quad_sphere, m), 3) for m in (8, 16, 32, 62)],
    "quads, by mesh, L = 2": [((control_meshes.quad_sphere, m), 2) for m in (16, 32, 64, 125)],
}


def exponent(sizes: list[float], seconds: list[float]) -> float:
    """The slope of log seconds over log size."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])


def measure(series: list, threads: int) -> list[dict[str, Any]]:
    """One series, its sizes in turns."""
    meshes = {k: make(m) for k, ((make, m), _) in enumerate(series)}
    bodies = {
        str(k): partial(runs.fair, meshes[k], levels=levels, threads=threads)
        for k, (_, levels) in enumerate(series)
    }
    points = []
    for times in timing.in_turns(bodies, REPEATS).values():
        report = times.pop("last")
        points.append(
            {
                **times,
                "triangles": report["triangles"],
                "iterations": runs.finest(report)["iterations"],
            }
        )
    return points


def run() -> dict[str, Any]:
    """All series, on one thread and on all."""
    result, rows = {}, []
    for threads in (1, 0):
        for name, series in SERIES.items():
            points = measure(series, threads)
            sizes = [p["triangles"] for p in points]
            entry: dict[str, Any] = {"points": points}
            for clock in ("wall", "processor"):
                # the least of some runs: what other work adds is not the program's
                entry[f"exponent_{clock}"] = exponent(sizes, [p[clock]["min"] for p in points])
            result[f"{name}, threads {threads or 'all'}"] = entry
            each = [f"{1e6 * p['processor']['min'] / p['triangles']:.2f}" for p in points]
            rows.append(
                [
                    name,
                    threads or "all",
                    f"{sizes[0] / 1e3:.0f} K … {sizes[-1] / 1e6:.2f} M",
                    entry["exponent_wall"],
                    entry["exponent_processor"],
                    " ".join(each),
                    " ".join(str(p["iterations"]) for p in points),
                ]
            )
    table.show(
        f"Time exponent (target {TARGET})",
        [
            "series",
            "threads",
            "triangles",
            "wall",
            "processor",
            "µs of processor a triangle",
            "iterations",
        ],
        rows,
    )
    return result
