# SPDX-License-Identifier: GPL-3.0-or-later
"""Solver: the same control mesh again and again while its vertices move."""

import threading

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from surfaces import as_lists, size_of

SAMPLES = ["icosahedron", "cube", "dodecahedron", "house", "creature", "wavy_patch"]
CURVED = ["total_curvature", "minimum_variation"]
SETTINGS = {
    "plain": {},
    "free boundary": {"boundary": "free"},
    "linear boundary": {"boundary": "linear"},
    "creases": {"crease_angle": 0.8, "corner_angle": 1.0},
    "region": {"region": [0, 1], "joint": "curvature"},
    "tolerance": {"interpolation": "approximate", "tolerance": 0.04},
    "epsilon": {"epsilon": 0.02},
    "total curvature": {"energy": "total_curvature"},
    "minimum variation": {"energy": "minimum_variation"},
    "total curvature, tolerance": {
        "energy": "total_curvature",
        "interpolation": "approximate",
        "tolerance": 0.04,
    },
    "total curvature, epsilon": {"energy": "total_curvature", "epsilon": 0.02},
}
LINEAR = ["plain", "free boundary", "linear boundary", "creases", "region"]


def sample(name):
    vertices, faces = meshes.ALL[name]()
    return np.asarray(vertices, float), as_lists(faces)


def moved(points, size=0.05, seed=1):
    return points + size * np.random.default_rng(seed).normal(size=points.shape)


def on_sphere(subdivisions):
    """A sphere's triangles, so that its surface of least total curvature is known."""
    vertices, faces = sample("icosahedron")
    points, triangles = [p / np.linalg.norm(p) for p in vertices], faces
    for _ in range(subdivisions):
        middle, finer = {}, []

        def between(a, b, middle=middle):
            key = (min(a, b), max(a, b))
            if key not in middle:
                p = points[a] + points[b]
                middle[key] = len(points)
                points.append(p / np.linalg.norm(p))
            return middle[key]

        for a, b, c in triangles:
            x, y, z = between(a, b), between(b, c), between(c, a)
            finer += [[a, x, z], [b, y, x], [c, z, y], [x, y, z]]
        triangles = finer
    return np.array(points), np.array(triangles)


def slid(points, size, seed):
    """The same sphere with its vertices elsewhere on it."""
    p = moved(points, size, seed)
    return p / np.linalg.norm(p, axis=1)[:, None]


@pytest.mark.parametrize("kind", SETTINGS)
@pytest.mark.parametrize("name", SAMPLES)
def test_the_first_surface_is_that_of_fair(name, kind):
    vertices, faces = sample(name)
    expected = df.fair(vertices, faces, 2, **SETTINGS[kind])
    result = df.Solver(vertices, faces, 2, **SETTINGS[kind]).solve()
    assert np.array_equal(result.vertices, expected.vertices)
    for own, other in zip(result.faces, expected.faces, strict=True):
        assert np.array_equal(own, other)
    assert np.array_equal(result.triangle_polygon, expected.triangle_polygon)
    assert np.array_equal(result.quad_polygon, expected.quad_polygon)
    assert np.array_equal(result.crease_edges, expected.crease_edges)
    assert result.shapes == [] and result.report["warm"] is False
    for key in ("iterations", "residuals", "converged", "largest_deviation", "predicted_bytes"):
        assert result.report[key] == expected.report[key]


def test_the_first_surface_with_weights():
    vertices, faces = sample("creature")
    settings = {"interpolation": "approximate", "weights": np.linspace(1, 9, len(vertices))}
    expected = df.fair(vertices, faces, 2, **settings).vertices
    assert np.array_equal(df.Solver(vertices, faces, 2, **settings).solve(vertices).vertices, expected)


@pytest.mark.parametrize("kind", LINEAR)
@pytest.mark.parametrize("name", SAMPLES)
def test_moved_surfaces_are_those_of_shapes(name, kind):
    """One linear map of the positions, however the solver came there."""
    vertices, faces = sample(name)
    way = [moved(vertices, 0.05, k) for k in range(3)] + [vertices, vertices * [1, 2, 0.5] + 3]
    expected = df.fair(vertices, faces, 3, shapes=way, **SETTINGS[kind]).shapes
    solver = df.Solver(vertices, faces, 3, **SETTINGS[kind])
    solver.solve()
    for positions, surface in zip(way, expected, strict=True):
        result = solver.solve(positions)
        assert np.array_equal(result.vertices[: len(vertices)], positions)
        assert np.abs(result.vertices - surface).max() < 1e-6 * size_of(positions)
        assert result.report["warm"] and result.report["converged"]
        assert result.report["residuals"][-1] <= 1e-8


def test_moved_surfaces_with_weights():
    vertices, faces = sample("creature")
    way = [moved(vertices, 0.1, k) for k in range(3)]
    settings = {"interpolation": "approximate", "weights": np.linspace(1, 9, len(vertices))}
    expected = df.fair(vertices, faces, 3, shapes=way, **settings).shapes
    solver = df.Solver(vertices, faces, 3, **settings)
    solver.solve()
    for positions, surface in zip(way, expected, strict=True):
        result = solver.solve(positions)
        assert result.report["warm"] and result.report["largest_deviation"] > 1e-3
        assert np.abs(result.vertices - surface).max() < 1e-6


def test_starting_elsewhere():
    """The first positions need not be those of the charts."""
    vertices, faces = sample("creature")
    shape = moved(vertices)
    expected = df.fair(vertices, faces, 3, shapes=[shape]).shapes[0]
    result = df.Solver(vertices, faces, 3).solve(shape)
    assert not result.report["warm"]
    assert np.abs(result.vertices - expected).max() < 1e-6


def test_a_tolerance_is_kept_wherever_vertices_go():
    vertices, faces = sample("creature")
    solver = df.Solver(vertices, faces, 2, interpolation="approximate", tolerance=0.04)
    solver.solve()
    shape = moved(vertices, 0.1)
    result = solver.solve(shape)
    away = np.linalg.norm(result.vertices[: len(vertices)] - shape, axis=1)
    assert 0.03 < away.max() <= 0.04
    expected = df.fair(
        vertices, faces, 2, shapes=[shape], interpolation="approximate", tolerance=0.04
    ).shapes[0]
    assert np.abs(result.vertices - expected).max() < 1e-6


def test_epsilon_lets_go_around_the_new_places():
    vertices, faces = sample("icosahedron")
    solver = df.Solver(vertices, faces, 3, epsilon=0.02)
    solver.solve()
    shape = moved(vertices)
    result = solver.solve(shape)
    away = np.linalg.norm(result.vertices[: len(vertices)] - shape, axis=1)
    assert 0 < away.max() <= 0.02
    expected = df.fair(vertices, faces, 3, epsilon=0.02, shapes=[shape]).shapes[0]
    assert np.abs(result.vertices - expected).max() < 1e-6


def test_a_drag_is_foreseen():
    """Once part of a mesh has begun to go somewhere, hardly an iteration is left."""
    vertices, faces = on_sphere(2)
    pulled = np.exp(-6 * np.linalg.norm(vertices - vertices[0], axis=1) ** 2)[:, None]
    solver = df.Solver(vertices, faces, 3)
    fresh = solver.solve().report["iterations"][-1]
    solver.solve(vertices + 0.05 * pulled * [0.2, 0.3, 1])
    for k in range(2, 6):
        result = solver.solve(vertices + 0.05 * k * pulled * [0.2, 0.3 * k, 1])
        assert result.report["iterations"][-1] <= 2 < fresh
        assert result.report["residuals"][-1] <= 1e-8


def test_affine_images_need_no_iteration():
    vertices, faces = on_sphere(2)
    matrix = np.array([[1, 0.4, 0], [-0.2, 3, 0.1], [0, 0, 0.5]])
    solver = df.Solver(vertices, faces, 3)
    first = solver.solve()
    result = solver.solve(vertices @ matrix + [4, 5, 6])
    assert result.report["iterations"] == [0]
    assert np.abs(result.vertices - (first.vertices @ matrix + [4, 5, 6])).max() < 1e-7


def test_the_same_positions_again_move_nothing():
    vertices, faces = sample("creature")
    solver = df.Solver(vertices, faces, 3)
    first = solver.solve()
    assert np.abs(solver.solve().vertices - first.vertices).max() < 1e-8


@pytest.mark.parametrize("energy", CURVED)
def test_a_sphere_stays_that_sphere(energy):
    vertices, faces = on_sphere(1)
    solver = df.Solver(vertices, faces, 3, energy)
    solver.solve()
    for k in range(1, 5):
        positions = slid(vertices, 0.03, k)
        result = solver.solve(positions)
        assert np.array_equal(result.vertices[: len(vertices)], positions)
        assert np.abs(np.linalg.norm(result.vertices, axis=1) - 1).max() < 1e-5
        assert result.report["warm"] and result.report["converged"]
        assert result.report["curvature"][-1]["converged"]


def test_steps_on_the_finest_level_alone():
    vertices, faces = on_sphere(1)
    solver = df.Solver(vertices, faces, 3, "total_curvature")
    fresh = solver.solve().report["curvature"]
    moved_on = solver.solve(slid(vertices, 0.01, 1)).report["curvature"]
    assert [level["level"] for level in fresh] == [1, 2, 3]
    assert [level["level"] for level in moved_on] == [3]
    assert moved_on[0]["accurate"] and moved_on[0]["energy"] <= 1.001 * moved_on[0]["start_energy"]


@pytest.mark.parametrize("energy", CURVED)
def test_a_dragged_cage_comes_to_the_least_energy(energy):
    """As low as level by level: another run's points lie elsewhere on the same surface."""
    vertices, faces = on_sphere(1)
    vertices = vertices * [1, 1.4, 0.8]
    pulled = np.exp(-6 * np.linalg.norm(vertices - vertices[0], axis=1) ** 2)[:, None]
    dragged = vertices + 0.1 * pulled * [0.2, 0.3, 0.5]
    solver = df.Solver(vertices, faces, 3, energy, measure=True)
    solver.solve()
    for share in (0.25, 0.5, 0.75, 1):
        result = solver.solve(vertices + share * (dragged - vertices))
    fresh = df.fair(dragged, faces, 3, energy)
    assert result.report["warm"] and result.report["converged"]
    own, other = (r.report["energy"]["result"]["total_curvature"] for r in (result, fresh))
    assert own == pytest.approx(other, rel=2e-3)
    assert np.abs(result.vertices - fresh.vertices).max() < 5e-3


@pytest.mark.parametrize("energy", CURVED)
def test_far_moves_start_level_by_level(energy):
    vertices, faces = on_sphere(1)
    solver = df.Solver(vertices, faces, 2, energy)
    solver.solve()
    far = vertices * np.where(np.arange(len(vertices)) % 2, 1.0, 2.0)[:, None]
    result = solver.solve(far)
    expected = df.fair(vertices, faces, 2, energy, shapes=[far]).shapes[0]
    assert not result.report["warm"]
    assert np.array_equal(result.vertices[: len(vertices)], far)
    assert np.abs(result.vertices - expected).max() < 1e-3


@pytest.mark.parametrize("energy", CURVED)
def test_symmetry_is_kept_on_the_way(energy):
    vertices, faces = on_sphere(1)
    solver = df.Solver(vertices, faces, 2, energy)
    solver.solve()
    image = [int(np.argmin(np.linalg.norm(vertices - p * [-1, 1, 1], axis=1))) for p in vertices]
    for k in range(1, 4):
        shift = np.random.default_rng(k).normal(scale=0.01, size=vertices.shape)
        positions = vertices + shift + shift[image] * [-1, 1, 1]
        positions = (positions + positions[image] * [-1, 1, 1]) / 2
        points = solver.solve(positions).vertices
        mirrored = points * [-1, 1, 1]
        nearest = np.linalg.norm(points[:, None] - mirrored[None], axis=2).min(axis=1)
        assert nearest.max() < 1e-13


@pytest.mark.parametrize("energy", ["thin_plate", *CURVED])
def test_any_number_of_threads_gives_the_same_bits(energy):
    vertices, faces = on_sphere(2)
    way = [vertices, *(slid(vertices, 0.01, k) for k in range(3)), vertices]
    one, three = (
        [solver.solve(positions).vertices for positions in way]
        for solver in (df.Solver(vertices, faces, 3, energy, threads=t) for t in (1, 3))
    )
    for a, b in zip(one, three, strict=True):
        assert np.array_equal(a, b)


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


def test_measuring():
    vertices, faces = sample("icosahedron")
    silent = df.Solver(vertices, faces, 2)
    for _ in range(2):
        energy = silent.solve(moved(vertices)).report["energy"]
        assert all(np.isnan(value) for surface in energy.values() for value in surface.values())
    loud = df.Solver(vertices, faces, 2, measure=True)
    assert loud.solve().report["energy"] == df.fair(vertices, faces, 2).report["energy"]
    energy = loud.solve(moved(vertices)).report["energy"]
    assert energy["result"]["thin_plate"] < energy["polyhedron"]["thin_plate"]


def test_properties_and_bytes():
    vertices, faces = on_sphere(2)
    solver = df.Solver(vertices, faces, 3, "thin_plate")
    assert (solver.control_vertices, solver.levels, solver.energy) == (len(vertices), 3, "thin_plate")
    assert repr(solver) == "Solver(162 control vertices, levels=3, energy='thin_plate')"
    built = solver.bytes
    solver.solve()
    for k in range(2):
        points = len(solver.solve(slid(vertices, 0.01, k)).vertices)
    kept = solver.bytes
    assert built > 24 * points and kept > built
    for k in range(2, 5):
        solver.solve(slid(vertices, 0.01, k))
    assert solver.bytes == kept  # nothing grows


@pytest.mark.parametrize("name", ["icosahedron", "torus_triangles", "wavy_patch", "single_triangle"])
def test_rebase_is_another_solver(name):
    vertices, faces = sample(name)
    solver = df.Solver(vertices, faces, 2)
    solver.solve()
    other = moved(vertices, 0.1)
    solver.rebase(other)
    result = solver.solve()
    assert not result.report["warm"]
    assert np.array_equal(result.vertices, df.fair(other, faces, 2).vertices)
    back = solver.solve(vertices)
    assert back.report["warm"]
    assert np.abs(back.vertices - df.fair(other, faces, 2, shapes=[vertices]).shapes[0]).max() < 1e-6


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


@pytest.mark.parametrize("energy", CURVED)
def test_rebase_of_steps(energy):
    vertices, faces = on_sphere(1)
    solver = df.Solver(vertices, faces, 2, energy)
    solver.solve()
    other = slid(vertices, 0.1, 3)
    solver.rebase(other)
    assert np.array_equal(solver.solve().vertices, df.fair(other, faces, 2, energy).vertices)


def test_rebase_refuses_bad_geometry_and_goes_on():
    vertices, faces = sample("icosahedron")
    solver = df.Solver(vertices, faces, 2)
    before = solver.solve().vertices
    flat = vertices.copy()
    a, b, c = faces[0]
    flat[c] = (flat[a] + flat[b]) / 2
    with pytest.raises(df.FairingError) as caught:
        solver.rebase(flat)
    assert caught.value.code == "DEGENERATE_FACE" and 0 in caught.value.elements
    result = solver.solve()
    assert result.report["warm"] and np.abs(result.vertices - before).max() < 1e-8


def test_bad_positions_are_named_and_change_nothing():
    vertices, faces = sample("icosahedron")
    solver = df.Solver(vertices, faces, 2)
    first = solver.solve().vertices
    bad = vertices.copy()
    bad[3, 1] = np.nan
    bad[7, 0] = np.inf
    for call in (solver.solve, solver.rebase):
        with pytest.raises(df.FairingError) as caught:
            call(bad)
        assert (caught.value.code, caught.value.elements) == ("NON_FINITE", [3, 7])
        for wrong in (vertices[:-1], vertices[:, :2], "abc"):
            with pytest.raises(df.FairingError) as caught:
                call(wrong)
            assert caught.value.code == "BAD_SHAPE"
    result = solver.solve()
    assert result.report["warm"] and np.abs(result.vertices - first).max() < 1e-8


def test_construction_refuses_what_fair_refuses():
    vertices, faces = sample("icosahedron")
    for settings, code in [
        ({"method": "back_leg"}, "BAD_OPTION"),
        ({"levels": 99}, "BAD_OPTION"),
        ({"energy": "least"}, "BAD_OPTION"),
        ({"memory_limit": 1000}, "TOO_LARGE"),
        ({"interpolation": "approximate", "weights": np.zeros(len(vertices))}, "UNDERDETERMINED"),
    ]:
        with pytest.raises(df.FairingError) as caught:
            df.Solver(vertices, faces, **settings)
        assert caught.value.code == code
    with pytest.raises(df.FairingError) as caught:
        df.Solver(vertices, [*faces, faces[0]])
    assert caught.value.code == "DUPLICATE_FACE"
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
    with pytest.raises(df.FairingError) as caught:
        solver.solve(moved(vertices), monitor=monitor)
    assert caught.value.code == "CANCELLED"
    result = solver.solve(vertices)
    assert not result.report["warm"] and np.array_equal(result.vertices, expected)


def test_progress_and_monitor_hear_of_a_solve():
    vertices, faces = sample("creature")
    solver = df.Solver(vertices, faces, 3)
    for _ in range(2):
        calls, monitor = [], df.Monitor()
        solver.solve(moved(vertices), progress=lambda *call, calls=calls: calls.append(call), monitor=monitor)
        assert calls[-1] == (1.0, "done")
        assert [fraction for fraction, _ in calls] == sorted(fraction for fraction, _ in calls)
        assert (monitor.fraction, monitor.phase) == (1.0, "done")


def test_an_exception_of_progress_comes_out_and_the_solver_goes_on():
    vertices, faces = sample("creature")
    solver = df.Solver(vertices, faces, 2)

    def fail(fraction, phase):
        raise KeyError(phase)

    with pytest.raises(KeyError):
        solver.solve(progress=fail)
    assert np.array_equal(solver.solve().vertices[: len(vertices)], vertices)


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


def test_the_caller_s_arrays_may_change_and_go():
    vertices, faces = sample("icosahedron")
    own, ids = vertices.copy(), np.array(faces)
    solver = df.Solver(own, ids, 2)
    expected = solver.solve().vertices
    own[:] = np.nan
    ids[:] = 0
    assert np.abs(solver.solve().vertices - expected).max() < 1e-8
    solver.rebase(vertices)
    assert np.array_equal(solver.solve().vertices, expected)


def test_isolated_vertices_and_no_levels():
    vertices, faces = sample("cube")
    vertices = np.vstack([vertices, [9, 9, 9]])
    for levels in (0, 1):
        solver = df.Solver(vertices, faces, levels)
        solver.solve()
        shape = vertices + np.arange(9)[:, None] * [0.01, 0, 0.02]
        result = solver.solve(shape)
        assert np.array_equal(result.vertices[:9], shape)
        assert result.report["warnings"][0]["code"] == "ISOLATED_VERTICES"
