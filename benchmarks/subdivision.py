# SPDX-License-Identifier: GPL-3.0-or-later
"""Beside Blender's Subdivision Surface on organic cages: our surface passes each vertex within half of the
largest distance by which the other misses one. Which bends less, and which has smaller folds?
"""

from collections.abc import Iterator, Sequence
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import rivals
import side_by_side
import table
from from_tests import measures

LEVELS = 3
SHARE = 0.5  # of the other's largest deviation
COLLECTED = (
    "spot_control_mesh.obj",
    "spot_low_resolution.obj",
    "fox.ply",
    "bob_small.ply",
    "cat_head.obj",
    "hand_lowres.obj",
    "fish_low_resolution.obj",
    "fish_control_mesh.obj",
    "penguin_control_mesh.obj",
    "catmark_helmet.obj",
    "catmark_pawn.obj",
    "loop_toroidal_tet.obj",
)
SETTINGS = {
    "thin plate": {"energy": "thin_plate"},
    "thin plate, tension ½": {"energy": "thin_plate", "tension": 0.5},
    "total curvature": {"energy": "total_curvature"},
}
FIGURES = ("E / 8π", "99 %", "99.9 %", "largest")


def cages() -> Iterator[tuple[str, np.ndarray, list[list[int]]]]:
    """Yields name, vertices and polygons of each cage."""
    yield "Suzanne", *side_by_side.suzanne()
    yield "creature", *from_tests.small_meshes().creature()
    for file in COLLECTED:
        if mesh := from_tests.collected(file):
            yield file.split(".")[0], *mesh
        else:
            print(f"subdivision: {file} is not here.")


def figures(points: np.ndarray, triangles: np.ndarray) -> dict[str, float]:
    """The total curvature, and the dihedral angles in degrees."""
    angles = measures.dihedrals(points, triangles)
    found = (
        measures.total_curvature(points, triangles) / (8 * np.pi),
        *np.quantile(angles, (0.99, 0.999)),
        angles.max(),
    )
    return dict(zip(FIGURES, map(float, found), strict=True))


def run() -> dict[str, Any]:
    """Measures all cages."""
    result: dict[str, Any] = {}
    for name, vertices, faces in cages():
        polygons = [list(map(int, face)) for face in faces]
        points, triangles = rivals.catmull_clark(vertices, polygons, LEVELS)
        deviation = np.linalg.norm(points[: len(vertices)] - vertices, axis=1).max()
        entry = {"Subdivision Surface": figures(points, triangles)}
        for setting, options in SETTINGS.items():
            ours = df.fair(
                vertices,
                polygons,
                levels=LEVELS,
                interpolation="approximate",
                tolerance=SHARE * deviation,
                repair="mend",
                **options,
            )
            entry[setting] = figures(ours.vertices, ours.triangles.astype(np.int64))
        result[name] = {"deviation": float(deviation), **entry}
    return result


def four(figures: dict[str, float]) -> str:
    """Total curvature and angles, in one cell."""
    text = " · ".join(f"{figures[key]:.3g}" for key in FIGURES)
    return text + (f" ({figures['crossing']:.0f} cross)" if figures.get("crossing") else "")


def beside_subdivision(result: dict[str, Any], ours: Sequence[tuple[str, str]]) -> str:
    """Each cage's four figures, Subdivision Surface's first; how many of ours are smaller."""
    heads = ["cage", "Subdivision Surface"]
    for _, label in ours:
        heads += [label, "smaller"]
    rows = []
    for cage, found in result.items():
        theirs = found["Subdivision Surface"]
        if not isinstance(theirs, dict):
            continue
        row = [f"`{cage}`", four(theirs)]
        for key, _ in ours:
            row += [four(found[key]), str(sum(found[key][k] < theirs[k] for k in FIGURES))]
        rows.append(row)
    return table.markdown(heads, rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "subdivision": beside_subdivision(
            result,
            [("thin plate", "thin plate, near"), ("total curvature", "total curvature, near")],
        ),
    }
