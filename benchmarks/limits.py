# SPDX-License-Identifier: GPL-3.0-or-later
"""Through the limit positions of organic cages: where Subdivision Surface passes, and fairer in
between? Four figures of bending, and crossings, beside that modifier's surface at the same level.
"""

import time
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import rivals
import table
from self_intersections import crossing_triangles
from subdivision import FIGURES, LEVELS, cages, figures

SETTINGS = {
    "through the cage": {"interpolation": "exact"},
    "limit": {"interpolation": "limit"},
    "Character": {"interpolation": "limit", "metric_exponent": 0.45, "pad_size": 0.7},
    "limit, pads ½": {"interpolation": "limit", "pad_size": 0.5},
    "limit, total curvature": {"interpolation": "limit", "energy": "total_curvature"},
}


def judged(points: np.ndarray, triangles: np.ndarray) -> dict[str, float]:
    """The four figures, and how many triangles cross others."""
    return {**figures(points, triangles), "crossing": crossing_triangles(points, triangles)}


def wall(points: np.ndarray) -> float:
    """Largest less smallest radius of the mug's outer wall, away from handle, rim and bottom, as a
    share of the mean.
    """
    x, y, z = points.T
    radius, away = np.hypot(x, y), np.abs(np.arctan2(y, x)) > 1.6
    outer = away & (z > 0.45) & (z < 1.5) & (radius > 0.92 * radius[away].max())
    return float(np.ptp(radius[outer]) / radius[outer].mean())


def walls() -> dict[str, float]:
    """How straight each surface keeps it."""
    mug = from_tests.modelled().mug()
    faces = [list(map(int, face)) for face in mug.faces]
    found = {"Subdivision Surface": wall(rivals.catmull_clark(mug.vertices, faces, LEVELS)[0])}
    for setting, options in SETTINGS.items():
        found[setting] = wall(
            df.fair(mug.vertices, faces, LEVELS, repair="mend", **options).vertices
        )
    table.show(
        "The mug's wall", ["surface", "spread of its radius"], list(map(list, found.items()))
    )
    return found


def run() -> dict[str, Any]:
    """All cages, then the mug."""
    result: dict[str, Any] = {}
    rows = []
    for name, vertices, faces in cages():
        polygons = [list(map(int, face)) for face in faces]
        other = judged(*rivals.catmull_clark(vertices, polygons, LEVELS))
        entry = {"Subdivision Surface": other}
        for setting, options in SETTINGS.items():
            start = time.process_time()
            ours = df.fair(vertices, polygons, levels=LEVELS, repair="mend", threads=1, **options)
            taken = time.process_time() - start
            own = judged(ours.vertices, ours.triangles.astype(np.int64))
            entry[setting] = {**own, "seconds": taken}
        result[name] = entry
        for setting, own in entry.items():
            better = sum(own[figure] < other[figure] for figure in FIGURES)
            seconds = f"{own['seconds']:.2f}" if "seconds" in own else ""
            figures_shown = [own[figure] for figure in (*FIGURES, "crossing")]
            rows.append(
                [name, setting, *figures_shown, seconds, "" if own is other else f"{better} of 4"]
            )
    table.show(
        "Through the limit positions",
        ["cage", "surface", *FIGURES, "crossing", "seconds", "smaller"],
        rows,
    )
    result["mug, spread of the wall's radius"] = walls()
    return result
