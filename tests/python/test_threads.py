# SPDX-License-Identifier: GPL-3.0-or-later
"""The result is the same, to the last bit, for any number of threads, any day."""

import control_meshes as meshes
import discrete_fairing as df
import folding_meshes as folding
import numpy as np
import pytest
from every_call import CALLS as EACH
from sheet_meshes import bulkhead

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
TIGHT = {"pad_size": 0.0, "relative_residual": 1e-8, "measure": True}
STEPS = {**TIGHT, "energy": "total_curvature"}
NEAR = {"interpolation": "approximate", "tolerance": 0.01}
# Further settings, each with the residual of its own tests.
MORE = {
    "pads": (meshes.creature, 3, TIGHT | {"pad_size": 0.5}),
    "wide_pads": (meshes.creature, 3, TIGHT | {"pad_size": 1.0}),
    "near_on_pads": (meshes.creature, 3, TIGHT | NEAR | {"pad_size": 0.5}),
    "tension": (meshes.creature, 3, TIGHT | {"tension": 0.5}),
    "region": (meshes.creature, 3, TIGHT | {"region": range(30), "joint": "curvature"}),
    "limit": (lambda: meshes.HOUSE, 4, {"interpolation": "limit", "tension": 0.3}),
    "sheets": (lambda: bulkhead()[0], 3, {}),
    "folds": (folding.rounded_box, 2, {}),
    "steps_on_sheets": (lambda: bulkhead()[0], 3, {"energy": "total_curvature"}),
    "steps_on_folds": (meshes.rough_ball, 2, STEPS),
    "steps_on_pads": (meshes.creature, 3, STEPS | {"pad_size": 0.5}),
    "steps_near": (meshes.creature, 2, STEPS | NEAR | {"pad_size": 1.0}),
    "steps_under_tension": (meshes.creature, 3, STEPS | {"tension": 0.5}),
    "variation": (meshes.creature, 2, TIGHT | {"energy": "minimum_variation"}),
    **{
        f"steps_on_{name}": (meshes.ALL[name], 2 if name == "creature" else 3, STEPS)
        for name in sorted({*meshes.ALL} - {"grid", "single_triangle", "three_handles"})
    },
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


@pytest.mark.parametrize("name", MORE)
def test_any_number_of_threads_with_more(name):
    mesh, levels, options = MORE[name]
    one, other = (df.fair(*mesh(), levels, threads=threads, **options) for threads in (1, 3))
    assert same(one, other) and lasting(one.report) == lasting(other.report)


def bits(result) -> dict:
    """The bytes of all its arrays, pairs included."""
    values = {name: getattr(result, name) for name in dir(result) if not name.startswith("_")}
    arrays = {
        f"{name} {k}": one
        for name, value in values.items()
        for k, one in enumerate(value if isinstance(value, tuple) else [value])
    }
    return {name: a.tobytes() for name, a in arrays.items() if isinstance(a, np.ndarray)}


@pytest.mark.parametrize("name", EACH)
def test_any_number_of_threads_of_each_call(name):
    one, other = (bits(EACH[name](threads=threads)) for threads in (1, 3))
    assert one and one == other
