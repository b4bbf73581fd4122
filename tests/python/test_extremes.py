# SPDX-License-Identifier: GPL-3.0-or-later
"""Extreme coordinates: a surface is finite or refused, and no call harms the next one."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from refusing import refusal

CURVED = ["total_curvature", "minimum_variation"]


def pulled(vertices, vertex, factor):
    out = np.array(vertices, float)
    out[vertex] *= factor
    return out


@pytest.mark.parametrize("energy", ["thin_plate", *CURVED])
@pytest.mark.parametrize("factor", [1e6, 1e9, 1e12])
def test_a_solver_forgets_a_vertex_that_went_far_away(energy, factor):
    """Its next surfaces are those of a solver that never saw that vertex, to the last bit."""
    vertices, faces = meshes.cube()
    expected = df.fair(vertices, faces, 2, energy).vertices
    solver = df.Solver(vertices, faces, 2, energy)
    solver.solve()
    assert np.isfinite(solver.solve(pulled(vertices, 7, factor)).vertices).all()
    back = solver.solve(vertices)
    assert not back.report["warm"] and np.array_equal(back.vertices, expected)
    assert np.abs(solver.solve(vertices).vertices - expected).max() < 1e-7


@pytest.mark.parametrize("energy", ["thin_plate", *CURVED])
@pytest.mark.parametrize("factor", [1e20, 1e60, 1e99])
def test_a_vertex_out_of_reach_is_named(energy, factor):
    vertices, faces = meshes.cube()
    solver = df.Solver(vertices, faces, 2, energy)
    expected = solver.solve().vertices
    for _ in range(2):
        error = refusal(solver.solve, pulled(vertices, 7, factor))
        assert (error.code, error.elements) == ("TOO_EXTREME", [7])
        assert error.kind == "vertex" and "1 vertex (7) lies" in str(error)
    for _ in range(3):
        assert np.abs(solver.solve(vertices).vertices - expected).max() < 1e-7
    error = refusal(
        df.fair, vertices, faces, 2, energy, shapes=[vertices, pulled(vertices, 3, factor)]
    )
    assert (error.code, error.elements) == ("TOO_EXTREME", [3])


def test_a_loose_vertex_may_be_anywhere():
    vertices, faces = meshes.cube()
    vertices = np.vstack([vertices, [1e30, 0, 0]])
    solver = df.Solver(vertices, faces, 2)
    solver.solve()
    assert solver.solve(pulled(vertices, 8, 1e30)).report["warm"]
    assert solver.solve(pulled(vertices, 8, 1e-30)).report["warm"]
