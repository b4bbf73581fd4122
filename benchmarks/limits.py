# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces through the limit positions of organic cages, as Subdivision Surface: are they fairer in between?
Four figures of bending, and crossings, beside that modifier's surface at the same level.
"""

import time
from typing import Any

import discrete_fairing as df
import numpy as np
import rivals
from self_intersections import crossing_triangles
from subdivision import LEVELS, beside_subdivision, cages, figures

PUSHED = "cage pushed out"
SETTINGS = {
    "through the cage": {"interpolation": "exact"},
    "limit": {"interpolation": "limit"},
    "Character": {"interpolation": "limit", "metric_exponent": 0.45, "pad_size": 0.7},
    "limit, pads ½": {"interpolation": "limit", "pad_size": 0.5},
    "limit, total curvature": {"interpolation": "limit", "energy": "total_curvature"},
}


def judged(points: np.ndarray, triangles: np.ndarray) -> dict[str, float]:
    """The four figures, and the number of triangles that cross others."""
    return {**figures(points, triangles), "crossing": crossing_triangles(points, triangles)}


def run() -> dict[str, Any]:
    """Measures all cages."""
    result: dict[str, Any] = {}
    for name, vertices, faces in cages():
        polygons = [list(map(int, face)) for face in faces]
        other = judged(*rivals.catmull_clark(vertices, polygons, LEVELS))
        pushed = judged(*rivals.catmull_clark_through(vertices, polygons, LEVELS))
        entry = {"Subdivision Surface": other, PUSHED: pushed}
        for setting, options in SETTINGS.items():
            start = time.process_time()
            ours = df.fair(vertices, polygons, levels=LEVELS, repair="mend", threads=1, **options)
            taken = time.process_time() - start
            own = judged(ours.vertices, ours.triangles.astype(np.int64))
            entry[setting] = {**own, "seconds": taken}
        result[name] = entry
    return result


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "limits": beside_subdivision(
            result,
            [
                (PUSHED, "the same, cage pushed out"),
                ("through the cage", "thin plate, *Through*"),
                ("limit", "thin plate"),
                ("Character", "*Character*"),
                ("limit, total curvature", "total curvature"),
            ],
        ),
    }
