# SPDX-License-Identifier: GPL-3.0-or-later
"""Is there a peak of curvature at the control vertices? The measure is curvature there over curvature one
ring away, for each energy; 1 is no peak. Boundary vertices and their neighbours are left out. Real meshes
are read from the collection that may lie beside the project.
"""

from collections.abc import Iterator
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import table
from fitted_curvature import FittedCurvature
from from_tests import measures

ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")
COLLECTED = {
    "bob": ("bob_small.ply", 3),
    "cat's head": ("cat_head.obj", 3),
    "hand": ("hand_lowres.obj", 2),
}
COLLECTED |= {"cow": ("spot_low_resolution.obj", 2)}
PEAK = 1.5  # over the ring's mean


def control_meshes() -> Iterator[tuple[str, np.ndarray, Any, int]]:
    """Yields name, vertices, polygons and levels of each mesh."""
    yield "creature", *from_tests.small_meshes().creature(), 3
    for name, (file, levels) in COLLECTED.items():
        if mesh := from_tests.collected(file):
            yield name, *mesh, levels
        else:
            print(f"peaks: {file} is not here.")


def ratios(points: np.ndarray, triangles: np.ndarray, count: int) -> np.ndarray:
    """(k, 2): at the first `count` vertices, the curvature over the mean and over the largest of
    their rings."""
    fitted = FittedCurvature(points, triangles)
    on_rim = np.zeros(len(points), bool)
    on_rim[measures.rim(triangles)] = True
    result = []
    for vertex in range(count):
        ring = fitted.ring(vertex)
        if len(ring) and not on_rim[vertex] and not on_rim[ring].any():
            around = fitted.at(ring)
            result.append(fitted.at([vertex])[0] / np.array([around.mean(), around.max()]))
    return np.array(result)


def summary(found: np.ndarray) -> dict[str, Any]:
    """Median, 95th percentile and largest value of both ratios, and the number of peaks."""
    entry = {"vertices": len(found), "peaks": int((found[:, 0] > PEAK).sum())}
    for key, values in zip(("over_mean", "over_largest"), found.T):
        entry[key] = [
            float(np.median(values)),
            float(np.percentile(values, 95)),
            float(values.max()),
        ]
    return entry


def run() -> dict[str, Any]:
    """Measures all meshes under all energies."""
    result: dict[str, Any] = {}
    for name, vertices, faces, levels in control_meshes():
        result[name] = {"levels": levels, "faces": len(faces)}
        for energy in ENERGIES:
            surface = df.fair(vertices, faces, levels=levels, energy=energy, measure=False)
            found = ratios(surface.vertices, surface.triangles.astype(np.int64), len(vertices))
            result[name][energy] = summary(found)
    return result


PEAKS = {
    "creature": "creature, 3 levels",
    "bob": "Bob, 3 levels",
    "cat's head": "cat's head, 3 levels",
    "hand": "hand, 2 levels",
    "cow": "cow (Spot's dense mesh), 2 levels",
}


def peaks_cell(found: dict[str, Any]) -> str:
    """A cell: median, 95 % and largest ratio, then the number of peaks."""
    return f"{' / '.join(f'{v:.2f}' for v in found['over_mean'])}, {found['peaks'] or 'none'}"


def peaks_table(result: dict[str, Any]) -> str:
    """Curvature at control vertices over the mean around them."""
    pads = table.measured("pads")
    rows = []
    for name, label in PEAKS.items():
        points = {
            "thin_plate": pads["real"][f"{name}, 0.0"],
            "total_curvature": pads["near along normals"][f"{name}, 0.0, 0.0"],
        }
        vertices = result[name]["thin_plate"]["vertices"]
        for energy in ("thin_plate", "total_curvature"):
            head = f"{label}, {vertices} vertices" if energy == "thin_plate" else ""
            cells = [peaks_cell(points[energy]), peaks_cell(result[name][energy])]
            rows.append([head, energy.replace("_", " "), *cells])
        # it has no loads: pads only make its start
        rows.append(["", "minimum variation", "", peaks_cell(result[name]["minimum_variation"])])
    return table.markdown(["", "energy", "on point forces", "on pads"], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "peaks": peaks_table(result),
    }
