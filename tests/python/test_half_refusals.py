# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a mesh that cannot be read, or has left its plane: refused as the whole would be, or mended."""

import discrete_fairing as df
import numpy as np
import pytest
from half_hulls import COUNT, hull

KEEL = [4 * i for i in range(COUNT)]


def refusal(call, *arguments, **options):
    with pytest.raises(df.FairingError) as caught:
        call(*arguments, **options)
    return caught.value


@pytest.mark.parametrize("call", [df.fair, df.Solver])
@pytest.mark.parametrize("repair", ["refuse", "mend"])
@pytest.mark.parametrize("offsets", [[0, 8, 4, 12], [0, 4, -4, 12]], ids=str)
def test_offsets_that_cut_no_faces(call, repair, offsets):
    points, faces = hull()
    flat = faces[:3].ravel(), np.array(offsets)
    options = {"symmetry_plane": "y", "repair": repair}
    error = refusal(call, points, flat, 1, **options)
    assert (error.code, str(error)) == ("BAD_SHAPE", str(refusal(call, points, flat, 1)))


@pytest.mark.parametrize("vertex", [0, 9], ids=["in the plane", "elsewhere"])
@pytest.mark.parametrize("value", [np.nan, np.inf, 1e120], ids=str)
def test_positions_that_are_none(vertex, value):
    """They are no border that has left the plane."""
    points, faces = hull()
    solver = df.Solver(points, faces, 1, symmetry_plane="y")
    points[vertex] = value
    expected = refusal(df.fair, points, faces, 1)
    for call in (df.fair, df.Solver):
        error = refusal(call, points, faces, 1, symmetry_plane="y")
        assert (error.code, error.elements) == ("NON_FINITE", [vertex])
        assert str(error) == str(expected)
        assert refusal(call, points, faces, 1, symmetry_plane="y", repair="mend").elements == [
            vertex
        ]
    for move in (solver.solve, solver.rebase):
        assert (refusal(move, points).code, refusal(move, points).elements) == (
            "NON_FINITE",
            [vertex],
        )
    shapes = {"shapes": [hull()[0], points], "symmetry_plane": "y"}
    error = refusal(df.fair, *hull(), 1, **shapes)
    assert (error.code, error.elements) == ("NON_FINITE", [vertex])


@pytest.mark.parametrize("off", [KEEL, KEEL[2:3]], ids=["all", "one"])
def test_a_border_that_leaves_the_plane_is_refused(off):
    points, faces = hull()
    away = points.copy()
    away[off, 1] = 0.2
    solver = df.Solver(points, faces, 1, symmetry_plane="y")
    expected = solver.solve().vertices
    for move in (solver.solve, solver.rebase):
        error = refusal(move, away)
        assert (error.code, error.kind, error.elements) == ("BAD_OPTION", "vertex", off)
        assert "not in the plane y = 0" in str(error)
    assert np.allclose(solver.solve(points).vertices, expected, atol=1e-4)
    error = refusal(df.fair, points, faces, 1, symmetry_plane="y", shapes=[points, away])
    assert (error.code, error.elements) == ("BAD_OPTION", off) and "in shape 1" in str(error)


def test_a_border_next_to_the_plane_is_put_into_it():
    near, faces = hull(jitter=1e-7)
    solver = df.Solver(hull()[0], faces, 1, symmetry_plane="y")
    for found in (df.fair(near, faces, 1, symmetry_plane="y"), solver.solve(near)):
        assert (found.vertices[KEEL, 1] == 0).all()
    assert near[KEEL, 1].all(), "the caller's array is not changed"


def test_faces_that_name_absent_vertices_are_mended_in_both_halves():
    """An id of the image is no id of the half; what is dropped leaves a border in the plane one."""
    points, faces = hull()
    count = len(points)
    absent = [[0, 4, count], [8, -1, 9], [5, 6, 2 * count]]
    options = {"symmetry_plane": "y", "repair": "mend"}
    mended = df.fair(points, [*faces.tolist(), *absent], 2, **options)
    sound = df.fair(points, faces, 2, symmetry_plane="y")
    assert np.allclose(mended.vertices, sound.vertices, atol=1e-6)
    (act,) = mended.report["repairs"]
    ids = list(range(len(faces), len(faces) + 3))
    assert (act["code"], act["elements"]) == ("INDEX_OUT_OF_RANGE", ids)
    assert act["message"].startswith(f"3 faces ({ids[0]}, ")
