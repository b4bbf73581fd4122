# SPDX-License-Identifier: GPL-3.0-or-later
"""Solver as an object: its arrays and properties, rebase, errors, cancelling, calls from several threads."""

import threading

import discrete_fairing as df
import numpy as np
import pytest
import tight
from moving import moved, sample
from refusing import refusal


def test_arrays_are_kept_or_new():
    vertices, faces = sample("dodecahedron")
    solver = df.Solver(vertices, faces, 2)
    first, second = solver.solve(), solver.solve(moved(vertices))
    assert first.vertices is not second.vertices and first.vertices.flags.writeable
    assert not np.shares_memory(first.vertices, second.vertices)
    for own, other in [
        *zip(first.faces, second.faces, strict=True),
        (first.triangle_polygon, second.triangle_polygon),
        (first.quad_polygon, second.quad_polygon),
        (first.crease_edges, second.crease_edges),
    ]:
        assert own is other and not own.flags.writeable


@pytest.mark.parametrize(
    "name", ["icosahedron", "torus_triangles", "wavy_patch", "single_triangle"]
)
def test_rebase_is_another_solver(name):
    vertices, faces = sample(name)
    solver = tight.Solver(vertices, faces, 2)
    solver.solve()
    other = moved(vertices, 0.1)
    solver.rebase(other)
    result = solver.solve()
    assert not result.report["warm"]
    assert np.array_equal(result.vertices, tight.fair(other, faces, 2).vertices)
    back = solver.solve(vertices)
    assert back.report["warm"]
    assert (
        np.abs(back.vertices - tight.fair(other, faces, 2, shapes=[vertices]).shapes[0]).max()
        < 1e-6
    )


def test_rebase_keeps_the_faces_where_other_ones_would_be_chosen():
    vertices, faces = sample("creature")
    solver = df.Solver(vertices, faces, 2, crease_angle=1.0)
    first = solver.solve()
    other = moved(vertices, 0.1)
    assert len(df.fair(other, faces, 2).faces[0]) != len(first.faces[0])  # more quads are warped
    solver.rebase(other)
    result = solver.solve()
    assert result.faces[0] is first.faces[0] and result.crease_edges is first.crease_edges
    assert np.array_equal(result.vertices[: len(vertices)], other) and result.report["converged"]


def test_bad_positions_are_named_and_change_nothing():
    vertices, faces = sample("icosahedron")
    solver = df.Solver(vertices, faces, 2)
    first = solver.solve().vertices
    bad, flat = vertices.copy(), vertices.copy()
    bad[3, 1] = np.nan
    bad[7, 0] = np.inf
    a, b, c = faces[0]
    flat[c] = (flat[a] + flat[b]) / 2
    error = refusal(solver.rebase, flat)
    assert error.code == "DEGENERATE_FACE" and 0 in error.elements
    for call in (solver.solve, solver.rebase):
        error = refusal(call, bad)
        assert (error.code, error.elements) == ("NON_FINITE", [3, 7])
        for wrong in (vertices[:-1], vertices[:, :2], "abc"):
            assert refusal(call, wrong).code == "BAD_SHAPE"
    result = solver.solve()
    assert result.report["warm"] and np.abs(result.vertices - first).max() < 1e-8


def test_construction_refuses_what_fair_refuses():
    vertices, faces = sample("icosahedron")
    free = {"interpolation": "approximate", "weights": np.zeros(len(vertices))}
    assert refusal(df.Solver, vertices, faces, method="back_leg").code == "BAD_OPTION"
    assert refusal(df.Solver, vertices, faces, memory_limit=1000).code == "TOO_LARGE"
    assert refusal(df.Solver, vertices, faces, **free).code == "UNDERDETERMINED"
    assert refusal(df.Solver, vertices, [*faces, faces[0]]).code == "DUPLICATE_FACE"
    for name in ("shapes", "progress", "monitor", "colour"):
        with pytest.raises(TypeError, match=name):
            df.Solver(vertices, faces, **{name: None})


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature"])
def test_a_cancelled_call_is_followed_by_a_fresh_one(energy):
    vertices, faces = sample("creature")
    solver = df.Solver(vertices, faces, 3, energy)
    expected = solver.solve().vertices
    monitor = df.Monitor()
    monitor.cancel()
    assert refusal(solver.solve, moved(vertices), monitor=monitor).code == "CANCELLED"
    result = solver.solve(vertices)
    assert not result.report["warm"] and np.array_equal(result.vertices, expected)


def test_one_call_at_a_time():
    vertices, faces = sample("icosahedron")
    solver = df.Solver(vertices, faces, 2)
    codes = []

    def again(fraction, phase):
        for call in (solver.solve, lambda: solver.rebase(vertices)):
            thread = threading.Thread(target=attempt, args=(call,))
            thread.start()
            thread.join()

    def attempt(call):
        try:
            call()
        except df.FairingError as error:
            codes.append(error.code)

    solver.solve(progress=again)
    assert codes and set(codes) == {"BUSY"}
    assert solver.solve().report["warm"]
