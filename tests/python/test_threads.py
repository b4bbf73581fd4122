# SPDX-License-Identifier: GPL-3.0-or-later
"""The result is the same, to the last bit, for any number of threads, any day."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest

CASES = {
    "closed": (meshes.creature, 4, {}),
    "quads": (lambda: meshes.torus(10, 8), 4, {}),
    "open": (lambda: meshes.wavy_patch(8, 8), 4, {"boundary": "free"}),
    "paper": (meshes.random_hull, 4, {"metric_exponent": 1.0}),
    "creases": (lambda: meshes.roof()[0], 4, {"crease_angle": 0.9}),
    "tolerance": (meshes.creature, 3, {"interpolation": "approximate", "tolerance": 0.01}),
    "weights": (
        meshes.creature,
        3,
        {"interpolation": "approximate", "weights": np.linspace(1, 9, 98)},
    ),
    "epsilon": (meshes.creature, 3, {"epsilon": 0.02}),
    "polygons": (meshes.dodecahedron, 4, {}),
    "pole": (lambda: meshes.closed_pole(60), 3, {}),
    "back_leg": (meshes.creature, 2, {"method": "back_leg"}),
}
TIMED = {"seconds", "threads", "predicted_bytes", "peak_bytes"}


def same(a, b) -> bool:
    arrays = [(a.vertices, b.vertices), (a.triangles, b.triangles), *zip(a.faces, b.faces)]
    return all(x.tobytes() == y.tobytes() for x, y in arrays)


def lasting(report) -> str:
    return repr({key: value for key, value in report.items() if key not in TIMED})


@pytest.mark.parametrize("name", sorted(CASES))
def test_any_number_of_threads(name):
    mesh, levels, options = CASES[name]
    vertices, faces = mesh()
    one = df.fair(vertices, faces, levels, threads=1, relative_residual=1e-3, **options)
    for threads in (2, 4, 8):
        other = df.fair(vertices, faces, levels, threads=threads, relative_residual=1e-3, **options)
        assert other.report["threads"] == threads
        assert same(one, other), f"{threads} threads"
        assert lasting(one.report) == lasting(other.report), f"{threads} threads"


@pytest.mark.parametrize("name", ["closed", "tolerance", "creases", "open"])
def test_the_same_again(name):
    mesh, levels, options = CASES[name]
    vertices, faces = mesh()
    first, second = (df.fair(vertices, faces, levels - 1, threads=2, **options) for _ in range(2))
    assert same(first, second) and lasting(first.report) == lasting(second.report)
