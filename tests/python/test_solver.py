# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of a Solver, the first time and after the vertices have moved."""

import control_meshes as meshes
import numpy as np
import pytest
import tight
from moving import icosphere, moved, sample
from one_sided_meshes import strip
from sheet_meshes import book
from surfaces import size_of

SAMPLES = ["icosahedron", "cube", "dodecahedron", "house", "creature", "wavy_patch"]
CURVED = ["total_curvature", "minimum_variation"]
SETTINGS = {
    "plain": {},
    "free boundary": {"boundary": "free"},
    "linear boundary": {"boundary": "linear"},
    "creases": {"crease_angle": 0.8, "corner_angle": 1.0},
    "region": {"region": [0, 1], "joint": "curvature"},
    "pads": {"pad_size": 0.5},
    "tension": {"tension": 0.6},
    "tolerance": {"interpolation": "approximate", "tolerance": 0.04},
    "tolerance on pads": {"pad_size": 0.5, "interpolation": "approximate", "tolerance": 0.04},
    "epsilon": {"epsilon": 0.02},
    "total curvature": {"energy": "total_curvature"},
    "minimum variation": {"energy": "minimum_variation"},
    "total curvature, tolerance": {
        "energy": "total_curvature",
        "interpolation": "approximate",
        "tolerance": 0.04,
    },
}
LINEAR = {
    "plain": 1e-6,
    "free boundary": 1e-6,
    "linear boundary": 1e-6,
    "creases": 1e-6,
    "region": 1e-6,
    "pads": 5e-5,  # whose loads are found to a tolerance of their own
    "tension": 1e-4,  # whose metric is that of the first positions
}


WEIGHTS = {"interpolation": "approximate", "weights": np.linspace(1, 9, 98)}
BORDER = {"linear": [(0, 1), (1, 2), (2, 3), (3, 4)], "free": [(20, 21), (22, 21), (22, 23)]}
SOFT = ([[11, 12], [12, 13]], 0.5)
# name: mesh, settings, how near moved surfaces are to those of shapes, in sizes, where they are linear
CASES = {
    f"{kind}, {name}": (sample(name), settings, LINEAR.get(kind))
    for kind, settings in SETTINGS.items()
    for name in SAMPLES
} | {
    "weights": (sample("creature"), WEIGHTS, 1e-6),
    "limit": (meshes.HOUSE, {"interpolation": "limit"}, 1e-6),
    "border edges": (sample("wavy_patch"), {"boundary_edges": BORDER}, 1e-6),
    "soft creases": (sample("wavy_patch"), {"soft_creases": SOFT}, 1e-6),
    "sheets": (book(3)[:2], {}, 1e-6),
    "one-sided": (strip(9, 2), {}, 1e-6),
}


@pytest.mark.parametrize("name", CASES)
def test_the_first_surface_is_that_of_fair(name):
    mesh, settings, _ = CASES[name]
    expected = tight.fair(*mesh, 2, **settings)
    result = tight.Solver(*mesh, 2, **settings).solve()
    assert np.array_equal(result.vertices, expected.vertices)
    for own, other in zip(result.faces, expected.faces, strict=True):
        assert np.array_equal(own, other)
    for key in ("triangle_polygon", "quad_polygon", "crease_edges"):
        assert np.array_equal(getattr(result, key), getattr(expected, key))
    assert result.shapes == [] and result.report["warm"] is False
    for key in ("iterations", "residuals", "converged", "largest_deviation", "predicted_bytes"):
        assert result.report[key] == expected.report[key]


@pytest.mark.parametrize("name", [name for name, (_, _, near) in CASES.items() if near])
def test_moved_surfaces_are_those_of_shapes(name):
    """They are one linear map of the positions, whichever way the solver came there, also at first."""
    (vertices, faces), settings, near = CASES[name]
    way = [moved(vertices, 0.05, k) for k in range(3)] + [vertices, vertices * [1, 2, 0.5] + 3]
    expected = tight.fair(vertices, faces, 3, shapes=way, **settings).shapes
    solver = tight.Solver(vertices, faces, 3, **settings)
    for positions, surface in zip(way, expected, strict=True):
        result = solver.solve(positions)
        away = np.linalg.norm(result.vertices[: len(vertices)] - positions, axis=1).max()
        assert (away > 1e-3) == ("interpolation" in settings)
        assert result.report["largest_deviation"] == pytest.approx(away, rel=1e-9, abs=1e-15)
        assert np.abs(result.vertices - surface).max() < near * size_of(positions)
        assert result.report["warm"] and result.report["converged"]
        assert result.report["residuals"][-1] <= 1e-8
    if name not in ("sheets", "one-sided"):  # test_solver_calls.py rebases others
        return
    solver.rebase(way[0])
    result, alone = solver.solve(), tight.fair(way[0], faces, 3, **settings)
    assert not result.report["warm"] and result.report["converged"]
    assert np.abs(result.vertices - alone.vertices).max() < near * size_of(vertices)


@pytest.mark.parametrize("kind", [k for k in SETTINGS if "tolerance" in k or k == "epsilon"])
def test_vertices_that_may_move_stay_near_where_they_have_gone(kind):
    vertices, faces = sample("creature")
    most = SETTINGS[kind].get("tolerance", SETTINGS[kind].get("epsilon"))
    solver = tight.Solver(vertices, faces, 2, **SETTINGS[kind])
    solver.solve()
    shape = moved(vertices, 0.1)
    result = solver.solve(shape)
    away = np.linalg.norm(result.vertices[: len(vertices)] - shape, axis=1)
    assert 0.75 * most < away.max() <= most
    expected = tight.fair(vertices, faces, 2, shapes=[shape], **SETTINGS[kind]).shapes[0]
    assert np.abs(result.vertices - expected).max() < 1e-6


@pytest.mark.parametrize("energy", CURVED)
def test_a_dragged_cage_comes_to_the_least_energy(energy):
    """Its energy is as low as level by level; the points of another run lie elsewhere on the same surface."""
    vertices, faces = icosphere(1)
    vertices = vertices * [1, 1.4, 0.8]
    pulled = np.exp(-6 * np.linalg.norm(vertices - vertices[0], axis=1) ** 2)[:, None]
    dragged = vertices + 0.1 * pulled * [0.2, 0.3, 0.5]
    solver = tight.Solver(vertices, faces, 3, energy, measure=True)
    solver.solve()
    for share in (0.25, 0.5, 0.75, 1):
        result = solver.solve(vertices + share * (dragged - vertices))
    fresh = tight.fair(dragged, faces, 3, energy)
    assert result.report["warm"] and result.report["converged"]
    own, other = (r.report["energy"]["result"]["total_curvature"] for r in (result, fresh))
    assert own == pytest.approx(other, rel=2e-3)
    assert np.abs(result.vertices - fresh.vertices).max() < 5e-3


@pytest.mark.parametrize("energy", CURVED)
def test_far_moves_start_level_by_level(energy):
    vertices, faces = icosphere(1)
    solver = tight.Solver(vertices, faces, 2, energy)
    solver.solve()
    far = vertices * np.where(np.arange(len(vertices)) % 2, 1.0, 2.0)[:, None]
    result = solver.solve(far)
    expected = tight.fair(vertices, faces, 2, energy, shapes=[far]).shapes[0]
    assert not result.report["warm"]
    assert np.array_equal(result.vertices[: len(vertices)], far)
    assert np.abs(result.vertices - expected).max() < 1e-3
