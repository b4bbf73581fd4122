# SPDX-License-Identifier: GPL-3.0-or-later
"""Options that name elements keep the input's ids through a mending, and so does a Solver."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import one_sided_meshes
import tight
from refusing import refusal
from surfaces import as_lists

BOX, RIM = meshes.box_with_creases()
POINTS, QUADS = BOX
SOUND = as_lists(QUADS)
# a duplicate before all others, so that no face keeps its id, and a vertex twice in a face
FACES = [SOUND[5], [*SOUND[0], SOUND[0][-1]], *SOUND[1:]]
N = len(POINTS)


def mend(vertices, faces, levels=2, **options):
    return tight.fair(vertices, faces, levels, repair="mend", **options)


def sound(order, **options):
    return tight.fair(POINTS, [SOUND[f] for f in order], 2, **options)


# what FACES comes to: its face 0 is the box's 5, which is therefore dropped later on
ORDER = [5, *(f for f in range(len(SOUND)) if f != 5)]


def assert_same(result, other):
    assert result.vertices.tobytes() == other.vertices.tobytes()


def test_creases_and_corners():
    assert_same(mend(POINTS, FACES, crease_edges=RIM), sound(ORDER, crease_edges=RIM))
    corners = [0, 7]
    given = mend(POINTS, FACES, crease_edges=RIM, corner_vertices=corners)
    assert_same(given, sound(ORDER, crease_edges=RIM, corner_vertices=corners))
    assert len(given.crease_edges) == len(RIM)


def test_regions_name_faces_of_the_input():
    top = [f for f, face in enumerate(FACES) if (POINTS[face][:, 2] == 1).all()]
    now = [f for f, face in enumerate(ORDER) if (POINTS[SOUND[face]][:, 2] == 1).all()]
    result = mend(POINTS, FACES, region=top)
    assert_same(result, sound(ORDER, region=now))
    for region in ([len(FACES)], [-1]):
        error = refusal(mend, POINTS, FACES, region=region)
        assert (error.code, error.elements) == ("INDEX_OUT_OF_RANGE", region)


def split_vertex():
    """The box with vertex N on vertex 3, named by a face in its place and by one without area."""
    faces = as_lists(QUADS)
    f = next(f for f, face in enumerate(faces) if 3 in face)
    at = faces[f].index(3)
    before = faces[f][at - 1]
    faces[f] = [N if v == 3 else v for v in faces[f]]
    return np.concatenate([POINTS, POINTS[3:4]]), [*faces, [3, N, before]]


def test_weights_and_tolerances_of_vertices_that_became_one():
    points, faces = split_vertex()
    for name, values in (
        ("tolerance", np.r_[np.full(N, 0.2), 0.0]),
        ("weights", np.r_[np.full(N, 3.0), np.inf]),
    ):
        result = mend(points, faces, interpolation="approximate", **{name: values})
        fixed = values[:N].copy()
        fixed[3] = values[N]
        other = sound(range(24), interpolation="approximate", **{name: fixed})
        assert np.array_equal(result.vertices[3], POINTS[3])
        assert np.allclose(result.vertices[:N], other.vertices[:N], rtol=0, atol=1e-9)
        assert (
            refusal(mend, points, faces, interpolation="approximate", **{name: values[:-1]}).code
            == "BAD_OPTION"
        )


def test_shapes_follow():
    points, faces = split_vertex()
    shape = points * [1, 2, 1]
    shape[N] += 1  # it was merged: only its vertex counts
    result = mend(points, faces, shapes=[shape, points])
    other = sound(range(24), shapes=[(POINTS * [1, 2, 1])])
    assert np.array_equal(result.shapes[0][:N], other.shapes[0][:N])
    assert np.array_equal(result.shapes[0][N], shape[3])
    assert np.array_equal(result.shapes[1], result.vertices)


CAP = np.array([[0.0, 0, 0], [4, 0, 0], [2, 3, 1], [2, -3, 1], [1, 0, 0]])
CAP_FACES = [[0, 1, 2], [0, 4, 1], [4, 0, 3], [1, 4, 3]]


def test_a_crease_along_a_cap_is_in_pieces():
    result = mend(CAP, CAP_FACES, 1, crease_edges=[(1, 0)])
    pairs = {tuple(sorted(e)) for e in result.crease_edges.tolist()}
    assert pairs == {(0, 4), (1, 4)}


def test_a_solver_on_a_mended_mesh():
    points, faces = split_vertex()
    solver = df.Solver(points, faces, 2, repair="mend", relative_residual=1e-8)
    once = solver.solve()
    assert_same(once, df.fair(points, faces, 2, repair="mend", relative_residual=1e-8))
    assert [r["code"] for r in once.report["repairs"]] == ["COINCIDENT_VERTICES", "DEGENERATE_FACE"]
    assert once.mended.vertex_origin[N] == 3
    moved = points * [1, 1, 1.5]
    moved[N] = 0
    result = solver.solve(moved)
    assert np.array_equal(result.vertices[:N], moved[:N])
    assert np.array_equal(result.vertices[N], moved[3])
    solver.rebase(moved)
    again = solver.solve()
    assert np.array_equal(again.vertices[N], moved[3])
    moved[N] = moved[3]
    once_more = df.fair(moved, faces, 2, repair="mend", relative_residual=1e-8)
    assert np.allclose(again.vertices, once_more.vertices, rtol=0, atol=1e-6)


def test_the_check_says_what_can_be_mended():
    points = np.concatenate([CAP, CAP[:1], [[np.nan] * 3]])
    faces = [[0, 1, 2], [2, 1, 0], [0, 4, 1], [0, 5, 3]]
    for mesh, code, repairable in [
        ((CAP, [[0, 1, 2], [1, 2, 0], [0, 0, 3]]), "REPEATED_VERTEX", True),
        ((CAP, [[0, 1, 2], [1, 2, 0], [0, 0, 3]]), "DUPLICATE_FACE", True),
        ((CAP, [[0, 1, 2], [1, 2, 0], [0, 0, 3]]), "DEGENERATE_FACE", True),
        ((CAP, [[0, 1, 2], [1, 2, 0], [0, 0, 3]]), "ISOLATED_VERTICES", False),
        ((points, faces), "NON_FINITE", True),
        ((points, [[0, 1, 6]]), "NON_FINITE", False),
        ((CAP, [[0, 1]]), "BAD_SHAPE", True),
        (one_sided_meshes.strip(7, 1), "NON_ORIENTABLE", False),
        ((points[:6], faces), "COINCIDENT_VERTICES", True),
    ]:
        assert {d.repairable for d in df.check(*mesh) if d.code == code} == {repairable}, code
