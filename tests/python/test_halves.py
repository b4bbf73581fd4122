# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a mesh with a symmetry plane: the surface is half of the whole mesh's and meets its image, and
errors, warnings and repairs name the half's own elements."""

import discrete_fairing as df
import numpy as np
import pytest
from half_hulls import COUNT, hull, whole
from refusing import refusal

TIGHT = {"relative_residual": 1e-11, "step_tolerance": 1e-10}
HALF = {"symmetry_plane": "y"}
MEND = {"repair": "mend"}
KEEL = [4 * i for i in range(COUNT)]
ENDS = [KEEL[0], KEEL[-1]]


@pytest.mark.parametrize(
    "options", [{}, {"energy": "total_curvature"}, {"interpolation": "limit"}], ids=str
)
def test_the_half_is_that_of_the_whole(options):
    points, faces = hull()
    half = df.fair(points, faces, 3, **options, **HALF, **TIGHT)
    both = df.fair(*whole(points, faces), 3, **options, **TIGHT)
    own = both.quad_polygon < len(faces)
    assert np.array_equal(half.quad_polygon, both.quad_polygon[own])
    there = both.vertices[both.faces[1][own]]
    assert np.allclose(half.vertices[half.faces[1]], there, atol=1e-7)
    assert np.array_equal(half.vertices[: len(points)], points) != ("interpolation" in options)
    assert len(half.vertices) == half.faces[1].max() + 1


def test_the_seam_lies_in_the_plane_and_its_normals_too():
    points, faces = hull()
    found = df.fair(points, faces, 4, **HALF)
    alone = df.fair(points, faces, 4, corner_vertices=ENDS)

    def seam_angles(result):
        quads = result.faces[1]
        at = np.isclose(result.vertices[:, 1], 0.0, atol=1e-12)
        rows = quads[at[quads].sum(axis=1) == 2]
        a, b, c, d = (result.vertices[rows[:, i]] for i in range(4))
        normals = np.cross(c - a, d - b)
        return np.degrees(np.abs(normals[:, 1] / np.linalg.norm(normals, axis=1)))

    assert (found.vertices[KEEL, 1] == 0).all()
    assert (found.vertices[:, 1] == 0).sum() == (COUNT - 1) * 16 + 1, "exactly"
    assert seam_angles(found).max() < 0.5 * seam_angles(alone).max(), "tangent across the plane"


def test_settings_by_vertex_edge_and_face_are_mirrored():
    points, faces = hull()
    tolerance = np.linspace(0, 0.05, len(points))
    crease = [[9, 13], [13, 17]]
    options = {"levels": 2, "interpolation": "approximate"}
    given = {"tolerance": tolerance, "crease_edges": crease, "corner_vertices": [10]}
    half = df.fair(points, faces, region=np.arange(12), **given, **HALF, **options)
    both_points, both_faces = whole(points, faces)
    number = {tuple(p): i for i, p in enumerate(both_points.tolist())}
    image = np.array([number[tuple(p)] for p in (points * [1, -1, 1]).tolist()])
    both_tolerance = np.zeros(len(both_points))
    both_tolerance[image] = both_tolerance[: len(points)] = tolerance
    both = df.fair(
        both_points,
        both_faces,
        tolerance=both_tolerance,
        crease_edges=crease + image[crease].tolist(),
        corner_vertices=[10, image[10]],
        region=[*range(12), *range(len(faces), len(faces) + 12)],
        **options,
    )
    there = both.vertices[both.faces[1][both.quad_polygon < len(faces)]]
    assert np.allclose(half.vertices[half.faces[1]], there, atol=1e-12)
    assert sorted(map(sorted, half.crease_edges.tolist())) == crease
    assert len(half.report["pads"]["widths"]) == len(points)


def test_shapes_and_mended_meshes_are_halved_too():
    points, faces = hull()
    options = {"shapes": [points * [1, 1, 2]], **HALF, **TIGHT}
    found = df.fair(points, np.concatenate([faces, faces[:1]]), 2, **MEND, **options)
    clean = df.fair(points, faces, 2, **options)
    assert np.allclose(found.shapes[0], clean.shapes[0])
    assert len(found.shapes[0]) == len(found.vertices)
    assert np.array_equal(found.shapes[0][: len(points)], options["shapes"][0])
    mended = found.mended
    assert len(mended.offsets) == len(faces) + 1 and mended.offsets[-1] == len(mended.corners)
    assert len(mended.vertex_origin) == len(points)
    assert len(mended.corner_origin) == len(mended.corners)
    assert mended.quad_face.max() < len(faces)


def test_the_solver_has_it():
    points, faces = hull()
    solver = df.Solver(points, faces, 2, **HALF)
    assert np.array_equal(solver.solve().vertices, df.fair(points, faces, 2, **HALF).vertices)
    moved = points + [0, 0, 0.1] * np.sin(points[:, :1])
    solver.rebase(moved)
    expected = df.fair(moved, faces, 2, **HALF).vertices
    assert np.allclose(solver.solve(moved).vertices, expected, atol=1e-4)
    assert solver.control_vertices == len(points)


def test_a_keel_that_is_creased_stays_sharp():
    points, faces = hull()
    keel = [list(ends) for ends in zip(KEEL, KEEL[1:])]
    sharp = df.fair(points, faces, 3, crease_edges=keel, **HALF, **TIGHT)
    assert sorted(map(sorted, sharp.crease_edges.tolist())) == keel
    alone = df.fair(points, faces, 3, corner_vertices=ENDS, **TIGHT)
    assert np.allclose(sharp.vertices, alone.vertices, atol=1e-7), "as its own border"


# --- refusals and repairs ---


def told(error):
    return error.code, error.kind, error.elements, str(error)


def changed(points=(), faces=(), more=()):
    """The hull with other rows of vertices and of faces, and more faces."""
    own, quads = hull()
    for row, value in points:
        own[row] = value
    for row, value in faces:
        quads[row] = value
    return own, np.concatenate([quads, *more])


QUADS = hull()[1]
BAD = {
    "turned": (changed(faces=[(7, QUADS[7, ::-1])]), {}),
    "twice": (changed(more=[QUADS[4:6]]), {}),
    "infinite": (changed(points=[(7, np.inf)]), {}),
    "no such crease": (hull(), {"crease_edges": [[9, 18], [5, 9]]}),
}


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("call", [df.fair, df.Solver])
def test_an_error_is_that_of_the_half_alone(name, call):
    mesh, options = BAD[name]
    alone = refusal(df.fair, *mesh, 2, **options)
    assert told(refusal(call, *mesh, 2, **HALF, **options)) == told(alone)


@pytest.mark.parametrize(
    "mesh, options, kind, element",
    [
        (hull(), {"corner_vertices": [3, 28]}, "vertex", 28),
        (hull(), {"region": [0, 18]}, "face", 18),
        (changed(faces=[(3, [12, 13, 28, 16])]), {}, "vertex", 28),
    ],
)
def test_ids_that_only_the_image_has_are_refused(mesh, options, kind, element):
    error = refusal(df.fair, *mesh, 2, **HALF, **options)
    assert (error.code, error.kind, error.elements) == ("INDEX_OUT_OF_RANGE", kind, [element])


def test_warnings_and_repairs_name_the_half_too():
    points, faces = changed(faces=[(9, QUADS[9, ::-1])], more=[QUADS[4:6]])
    points = np.concatenate([points, [[0, 5, 0]]])
    report, expected = (df.fair(points, faces, 2, **MEND, **half).report for half in (HALF, {}))
    for name in ("warnings", "repairs", "flipped_faces"):
        assert report[name] == expected[name], name


@pytest.mark.parametrize("off", [KEEL, KEEL[2:3]], ids=["all", "one"])
def test_a_border_that_leaves_the_plane_is_refused(off):
    points, faces = hull()
    away = points.copy()
    away[off, 1] = 0.2
    solver = df.Solver(points, faces, 1, **HALF)
    expected = solver.solve().vertices
    for call, arguments, options in (
        (solver.solve, (away,), {}),
        (solver.rebase, (away,), {}),
        (df.fair, (points, faces, 1), {"shapes": [points, away], **HALF}),
    ):
        error = refusal(call, *arguments, **options)
        assert (error.code, error.kind, error.elements) == ("BAD_OPTION", "vertex", off)
        assert "shapes" not in options or "in shape 1" in str(error)
    assert np.allclose(solver.solve(points).vertices, expected, atol=1e-4)


def test_a_border_next_to_the_plane_is_put_into_it():
    near, faces = hull(jitter=1e-7)
    solver = df.Solver(hull()[0], faces, 1, **HALF)
    for found in (df.fair(near, faces, 1, **HALF), solver.solve(near)):
        assert (found.vertices[KEEL, 1] == 0).all()
    assert near[KEEL, 1].all(), "the caller's array is not changed"


@pytest.mark.parametrize("plane", ["x", "w", "", 1, True])
def test_planes_that_are_none(plane):
    error = refusal(df.fair, *hull(), 1, symmetry_plane=plane)
    assert error.code == "BAD_OPTION" and "symmetry_plane" in str(error)
