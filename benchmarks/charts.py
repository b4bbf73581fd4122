# SPDX-License-Identifier: GPL-3.0-or-later
"""Iterations on the finest level against the metric exponent: skew in the metric is what a smoother
suffers from."""

from typing import Any

import control_meshes
import runs
import table

EXPONENTS = (1.0, 0.75, 0.5, 0.0)
DEGREE = 4  # of the smoother, for figures that compare; 0, the default, chooses it
MESHES = {
    "icosahedron, L = 4": (control_meshes.sphere(1, 0.0), 4),
    "cube of quads, L = 4": (control_meshes.quad_sphere(1, 0.0), 4),
    "torus 8 × 6, L = 3": (control_meshes.torus(8, 6, 0.0), 3),
    "torus of quads 8 × 6, L = 3": (control_meshes.quad_torus(8, 6, 0.0), 3),
    "hull of 20, L = 4": (control_meshes.hull(20), 4),
    "hull of 100, L = 3": (control_meshes.hull(100), 3),
    "fan of 64, L = 3": (control_meshes.fan(64), 3),
    "rough sphere 720, L = 3": (control_meshes.sphere(6), 3),
    "rough quads 384, L = 3": (control_meshes.quad_sphere(8), 3),
}


def entry(report: dict[str, Any]) -> str:
    """Iterations, with the smoother's degree or "d" for a direct solve; "+" where it gave up."""
    level = runs.finest(report)
    how = "d" if level["direct"] else str(level["smoother_degree"])
    return f"{level['iterations']}{'' if level['converged'] else '+'} ({how})"


def run() -> dict[str, Any]:
    """Every mesh, exponent and way to choose the degree."""
    result, rows = {}, []
    for name, (mesh, levels) in MESHES.items():
        for degree in (DEGREE, 0):
            reports = [
                runs.fair(
                    mesh, levels=levels, metric_exponent=b, smoother_degree=degree, measure=False
                )
                for b in EXPONENTS
            ]
            result[f"{name}, degree {degree or 'chosen'}"] = [runs.finest(r) for r in reports]
            rows.append([name, degree or "chosen", *[entry(r) for r in reports]])
    table.show(
        "Iterations (degree of the smoother; d: a direct level) by metric exponent",
        ["mesh", "degree", *[f"{b:g}" for b in EXPONENTS]],
        rows,
    )
    return result
