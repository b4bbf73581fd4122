# SPDX-License-Identifier: GPL-3.0-or-later
"""Is there a peak of curvature at the control vertices? Its size there over that one ring away, for
each energy.

One is none; vertices on boundaries, and next to them, are left out. "exact sphere" is what the
measure itself says of a surface without peaks. Real meshes are read from the collection that may
lie beside the project.
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
HEADS = (
    "over the ring's mean: median",
    "95 %",
    "largest",
    "over its largest: median",
    "95 %",
    "largest",
    "peaks",
)
PEAK = 1.5  # over the ring's mean


def control_meshes() -> Iterator[tuple[str, np.ndarray, Any, int]]:
    """Name, vertices, polygons, levels."""
    yield "creature", *from_tests.small_meshes().creature(), 3
    mesh_files, shared_data = from_tests.readers()
    for name, (file, levels) in COLLECTED.items():
        paths = sorted((shared_data.SHARED / "good" / "cages").glob(f"*{file}"))
        if paths:
            yield name, *mesh_files.read_mesh(paths[0]), levels
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
    """Median, 95th percentile and largest of both, and how many are peaks."""
    entry = {"vertices": len(found), "peaks": int((found[:, 0] > PEAK).sum())}
    for key, values in zip(("over_mean", "over_largest"), found.T):
        entry[key] = [
            float(np.median(values)),
            float(np.percentile(values, 95)),
            float(values.max()),
        ]
    return entry


def row(entry: dict[str, Any]) -> list[str]:
    """The table's cells."""
    figures = [f"{x:.2f}" for x in entry["over_mean"] + entry["over_largest"]]
    return [*figures, f"{entry['peaks']} of {entry['vertices']}"]


def exact_sphere() -> dict[str, Any]:
    """The hull of 20 points, refined, with all points put on the sphere."""
    vertices, faces = from_tests.small_meshes().random_hull(20)
    result = df.fair(vertices, faces, levels=3, measure=False)
    points = result.vertices / np.linalg.norm(result.vertices, axis=1)[:, None]
    return summary(ratios(points, result.triangles.astype(np.int64), len(vertices)))


def run() -> dict[str, Any]:
    """All meshes and energies."""
    result: dict[str, Any] = {"exact sphere": exact_sphere()}
    rows = [["exact sphere", "", *row(result["exact sphere"])]]
    for name, vertices, faces, levels in control_meshes():
        result[name] = {"levels": levels, "faces": len(faces)}
        for energy in ENERGIES:
            surface = df.fair(vertices, faces, levels=levels, energy=energy, measure=False)
            found = ratios(surface.vertices, surface.triangles.astype(np.int64), len(vertices))
            result[name][energy] = summary(found)
            rows.append([f"{name}, L = {levels}", energy, *row(result[name][energy])])
    title = f"Curvature √(κ₁² + κ₂²) at a control vertex over that one ring away; a peak is over {PEAK} times the mean"
    table.show(title, ["mesh", "energy", *HEADS], rows)
    return result
