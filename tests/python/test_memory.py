# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory is predicted, and grows as the surface does."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import sheet_meshes
import thin_walls
from half_hulls import hull
from one_sided_meshes import strip
from refusing import refusal

NEAR = {"interpolation": "approximate"}
POINTS = {"pad_size": 0.0, "relative_residual": 1e-2}
STEPS = {"energy": "total_curvature", "pad_size": 0.0}
VARIATION = {"energy": "minimum_variation"}
MEND = {"repair": "mend", "weld": 0.0}


def assert_bounded(report):
    """The prediction is a bound, and up to twice the peak."""
    few = 2**16  # bytes of what does not grow with the mesh
    assert report["peak_bytes"] <= report["predicted_bytes"] <= 2 * report["peak_bytes"] + few


def poles():
    """Thin faces, which make levels hard."""
    parts = [meshes.closed_pole(360) for _ in range(4)]
    vertices = np.concatenate([points + [3 * k, 0, 0] for k, (points, _) in enumerate(parts)])
    return vertices, np.concatenate([faces + k * 362 for k, (_, faces) in enumerate(parts)])


def egg():
    """Even faces of an egg: on a sphere nothing varies, and no step to less variation is taken."""
    vertices, faces = meshes.icosahedron()
    return vertices * [1, 1, 1.5], faces


def apart(mesh, count=None):
    """The first `count` faces of a mesh, none joined to another, as in STL."""
    points, faces = mesh
    faces = faces[:count]
    return points[faces.reshape(-1)], np.arange(faces.size).reshape(faces.shape)


BALL = meshes.refine_triangles(*meshes.icosahedron())
TORUS = meshes.torus(96, 48)
ON_POINTS = ("icosahedron", "random_hull", "torus_quads", "wavy_patch", "creature", "dodecahedron")
# name: mesh, levels, options
CASES = {
    **{f"{n} on points": (meshes.ALL[n](), (1, 2, 3, 4, 5), POINTS) for n in ON_POINTS},
    "tolerance": (meshes.creature(), (3,), NEAR | {"tolerance": 0.02}),
    "weights": (meshes.creature(), (3,), NEAR | {"weights": [1.0] * 98}),
    # levels that are factored: small ones, two at a time; the first one; one that proves hard
    "cube, tolerance": (meshes.cube(), (1, 2, 3, 4), NEAR | {"tolerance": 0.02}),
    "first level": (meshes.torus(24, 16), (1,), {"energy": "minimum_variation"}),
    "hard level": (meshes.random_hull(140), (2,), {"energy": "total_curvature"}),
    "tension": (meshes.creature(), (3,), {"tension": 0.5}),
    "steps under tension": (meshes.creature(), (3,), STEPS | {"tension": 0.5}),
    **{
        f"{n} by {energy}": (meshes.ALL[n](), (3,), STEPS | {"energy": energy})
        for n in ("random_hull", "torus_quads", "wavy_patch")
        for energy in ("total_curvature", "minimum_variation")
    },
    # the rows of level 1 are the most there, and control vertices that move are factored
    "many faces": (TORUS, (1, 2), {}),
    "many faces, tolerance": (TORUS, (1,), NEAR | {"tolerance": 0.02}),
    # lines on thin faces, and minimum variation but on even ones
    "thin faces": (poles(), (2,), {}),
    "quads, variation": (meshes.torus(), (3, 4), VARIATION),
    "creature, variation": (meshes.creature(), (3,), VARIATION),
    "9,700 points, variation": (meshes.random_hull(40), (4,), VARIATION),
    "even, variation": (egg(), (5,), VARIATION),
    "thin walls at limit positions": (thin_walls.sheet()[:2], (5,), {"interpolation": "limit"}),
    "a sheet at limit positions": (meshes.wavy_patch(2, 2), (6, 7), {"interpolation": "limit"}),
    # whatever is fixed, merged away or apart
    "ball": (BALL, (2, 3), {}),
    "ball of STL": (apart(BALL), (2, 3), MEND),
    "random hull": (meshes.random_hull(60), (2, 3), {}),
    "torus": (meshes.torus(24, 16), (2, 3), {}),
    "wavy patch": (meshes.wavy_patch(12, 12), (2, 3), {}),
    "creature": (meshes.creature(), (2, 3), {}),
    "dodecahedron": (meshes.dodecahedron(), (2, 3), {}),
    "drum": (meshes.drum(16)[0], (2, 3), {"crease_edges": meshes.drum(16)[1]}),
    "triangles apart": (apart(BALL, 60), (2, 3), {}),
    "quads apart": (apart(meshes.torus(24, 16), 60), (2, 3), {}),
    "pole": (meshes.closed_pole(180), (2, 3), {}),
}


@pytest.mark.parametrize(
    "name, levels", [(name, levels) for name, case in CASES.items() for levels in case[1]]
)
def test_the_prediction_bounds_the_peak_and_is_near_it(name, levels):
    mesh, _, options = CASES[name]
    assert_bounded(df.fair(*mesh, levels, threads=1, measure=True, **options).report)


@pytest.mark.parametrize("levels", [1, 2, 4])
@pytest.mark.parametrize("name", ["icosahedron", "torus_quads", "wavy_patch", "dodecahedron"])
def test_prediction_bounds_the_peak_of_limit(name, levels):
    """It includes the subdivision surface that the plate follows, in later solves too."""
    vertices, faces = meshes.ALL[name]()
    solver = df.Solver(vertices, faces, levels, interpolation="limit", threads=1)
    first = solver.solve(vertices).report
    later = solver.solve(np.asarray(vertices) * [1, 1, 1.01]).report
    assert_bounded(first)
    assert later["peak_bytes"] <= later["predicted_bytes"]


# name: mesh, levels, options, those of predicted_size()
ALONE = {
    **{name: (meshes.OPEN[name](), 2, {}, {}) for name in meshes.OPEN},
    **{
        energy: (meshes.torus(), 3, {"energy": energy}, {"energy": energy})
        for energy in ("total_curvature", "minimum_variation")
    },
    "shapes": (BALL, 4, {"shapes": [k * BALL[0] for k in (2, 3, 4)]}, {"shapes": 3}),
    "normals": (BALL, 3, {"normals": BALL[0]}, None),
    "pages": (sheet_meshes.book(4)[:2], 3, {}, {}),
    "pages of triangles": (sheet_meshes.book(3, triangles=True)[:2], 3, {}, {}),
    "touching": (sheet_meshes.hourglass(), 3, {}, {}),
    "wall": (sheet_meshes.bulkhead()[0], 3, {}, {}),
    "half": (hull(), 4, {"symmetry_plane": "y"}, {"halved": True}),
    # every face is solved twice, and written once
    **{f"one-sided, {cut}": (strip(triangles=cut), 2, {}, {}) for cut in (False, True)},
    "one-sided with a hexagon": (
        (strip(9, 2)[0], [[0, 3, 4, 5, 2, 1], *strip(9, 2)[1][2:].tolist()]),
        2,
        {},
        {},
    ),
}


@pytest.mark.parametrize("name", ALONE)
def test_sizes_are_predicted_from_faces_alone(name):
    (vertices, faces), levels, options, told = ALONE[name]
    result = df.fair(vertices, faces, levels, **options)
    assert result.report["peak_bytes"] <= result.report["predicted_bytes"]
    if told is None:
        return
    size = df.predicted_size(len(vertices), faces, levels, **told)
    assert size["vertices"] == len(result.vertices)
    assert size["triangles"] == len(result.triangles)
    rel = 0.1 if "halved" in told else 0
    assert size["bytes"] == pytest.approx(result.report["predicted_bytes"], rel=rel, abs=0)


def test_what_is_over_the_limit_by_shapes_alone_is_refused():
    size = df.predicted_size(len(BALL[0]), BALL[1], 4)["bytes"]
    assert (
        refusal(df.fair, *BALL, 4, shapes=[BALL[0]] * 4, memory_limit=size + 1).code == "TOO_LARGE"
    )


def hard():
    """A run with a level that is factored on the way, which cannot be predicted."""
    points, faces = meshes.torus(10, 8)
    rough = points + 0.2 * np.random.default_rng(1).normal(size=points.shape)
    return rough, faces, 3, "total_curvature"


def test_a_run_that_takes_more_says_so():
    report = df.fair(*hard(), threads=1).report
    assert 1.1 < report["peak_bytes"] / report["predicted_bytes"] <= 2
    assert "MEMORY_EXCEEDED" in [w["code"] for w in report["warnings"]]
