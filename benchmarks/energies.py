# SPDX-License-Identifier: GPL-3.0-or-later
"""The cost of total curvature beside the thin plate, and of pads beside point forces: default settings, CPU
time on one thread, in turns.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import control_meshes as meshes
import discrete_fairing as df
import from_tests
import side_by_side
import table
import timing

REPEATS = 3
COMPETITORS = {
    "plate on needles": {"pad_size": 0.0},
    "plate": {},
    "curvature on needles": {"energy": "total_curvature", "pad_size": 0.0},
    "curvature": {"energy": "total_curvature"},
}


def cases() -> dict[str, tuple[Callable[[], Any], int]]:
    """{name: (maker of the mesh, levels)}."""
    bob, cat, hand = "bob_small.ply", "cat_head.obj", "hand_lowres.obj"
    return {
        "rough sphere, 80 faces, 4": (partial(meshes.sphere, 2), 4),
        "rough sphere, 720 faces, 3": (partial(meshes.sphere, 6), 3),
        "torus, 10 x 8 quads, 3": (partial(meshes.quad_torus, 10, 8), 3),
        "hull, 76 faces, 5": (partial(meshes.hull, 40), 5),
        "bob, 3": (partial(from_tests.collected, bob), 3),
        "cat head, 3": (partial(from_tests.collected, cat), 3),
        "hand, 2": (partial(from_tests.collected, hand), 2),
        "Suzanne, 2": (side_by_side.suzanne, 2),
        "Suzanne, 3": (side_by_side.suzanne, 3),
    }


def measure(mesh: Any, levels: int) -> dict[str, Any]:
    """Seconds of each competitor, and the figures of the finest level of total curvature."""
    vertices, faces = mesh
    run = partial(df.fair, vertices, faces, levels=levels, threads=1, repair="mend")
    turns = timing.in_turns(
        {name: partial(run, **options) for name, options in COMPETITORS.items()}, REPEATS
    )
    work = turns["curvature"]["last"].report["curvature"][-1]["work"]
    return {
        **{name: turns[name]["processor"]["min"] for name in COMPETITORS},
        "pads": turns["plate"]["processor"]["min"] / turns["plate on needles"]["processor"]["min"],
        "ratio": turns["curvature"]["processor"]["min"] / turns["plate"]["processor"]["min"],
        "work": {name: int(count) for name, count in work.items()},
    }


def run() -> dict[str, Any]:
    """Measures all meshes that are present."""
    result = {}
    for name, (make, levels) in cases().items():
        mesh = make()
        if mesh is not None:
            result[name] = measure(mesh, levels)
    return result


def pads_table(result: dict[str, Any]) -> str:
    """The cost of pads beside point forces, for both energies."""
    heads = ["control mesh, level", "thin plate, point forces", "on pads", "ratio"]
    heads += ["total curvature, point forces", "on pads", "ratio"]
    rows = []
    for name, e in result.items():
        points, pads = e["curvature on needles"], e["curvature"]
        row = [f"{e['plate on needles']:.3f} s", f"{e['plate']:.3f} s", table.short(e["pads"], 3)]
        rows.append([name, *row, f"{points:.2f} s", f"{pads:.2f} s", table.short(pads / points, 3)])
    return table.markdown(heads, rows)


def total_curvature_table(result: dict[str, Any]) -> str:
    """The cost of total curvature beside the thin plate, and the steps of its finest level."""
    heads = ["control mesh, level", "thin plate", "total curvature", "ratio"]
    heads += ["steps", "iterations", "factors"]
    rows = []
    for name, e in result.items():
        times = [f"{e['plate']:.3f} s", f"{e['curvature']:.2f} s", table.short(e["ratio"])]
        work = [str(e["work"][key]) for key in ("steps", "iterations", "factors")]
        rows.append([name, *times, *work])
    return table.markdown(heads, rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "pads.cost": pads_table(result),
        "total_curvature.cost": total_curvature_table(result),
    }
