# SPDX-License-Identifier: GPL-3.0-or-later
"""50 K triangles, the size of [Kobbelt 1997a]'s own figure: 10 seconds, in 1997, on a workstation
of then.

Multigrid to the solution of the linear system beside the paper's refine-and-smooth, which stops
wherever its sweeps have got to: so the energy that each reaches stands beside its time.
"""

from functools import partial
from typing import Any

import control_meshes
import discrete_fairing as df
import runs
import table
import timing

PAPER_SECONDS = 10.0
REPEATS = 5
SWEEPS = (10, 100)
MESHES = {
    "triangles, L = 3": (control_meshes.sphere(6), 3),
    "triangles, L = 5": (control_meshes.sphere(2, 0.1), 5),
    "quads, L = 3": (control_meshes.quad_sphere(8), 3),
}


def competitors(mesh: Any, levels: int) -> dict[str, Any]:
    """The methods that this build has."""
    base = {"levels": levels, "pad_size": 0, "relative_residual": 1e-8}
    bodies = {
        "multigrid": partial(runs.fair, mesh, **base),
        "multigrid, 1 thread": partial(runs.fair, mesh, threads=1, **base),
    }
    for sweeps in SWEEPS:
        options = {"method": "back_leg", "sweeps": sweeps, **base}
        try:
            runs.fair(control_meshes.sphere(1), **{**options, "levels": 1})
        except df.FairingError as error:
            print(f"back_leg: {error}")
            break
        bodies[f"back leg, {sweeps} sweeps"] = partial(runs.fair, mesh, **options)
    return bodies


def run() -> dict[str, Any]:
    """All meshes and methods, in turns."""
    result, rows = {}, []
    for name, (mesh, levels) in MESHES.items():
        times = timing.in_turns(competitors(mesh, levels), REPEATS)
        solution = times["multigrid"]["last"]["energy"]["result"]["thin_plate"]
        for method, entry in times.items():
            report = entry.pop("last")
            entry["triangles"] = report["triangles"]
            entry["excess"] = report["energy"]["result"]["thin_plate"] / solution - 1
            wall = entry["wall"]
            rows.append(
                [
                    name,
                    method,
                    report["triangles"],
                    wall["median"],
                    f"{wall['min']:.3f} … {wall['max']:.3f}",
                    entry["processor"]["median"],
                    PAPER_SECONDS * report["triangles"] / 50000 / wall["median"],
                    f"{entry['excess']:.1e}",
                ]
            )
        result[name] = times
    table.show(
        f"50 K triangles (the paper, 1997: {PAPER_SECONDS:g} s)",
        [
            "mesh",
            "method",
            "triangles",
            "wall",
            "from … to",
            "processor",
            "times faster",
            "energy above least",
        ],
        rows,
    )
    return result
