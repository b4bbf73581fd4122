# SPDX-License-Identifier: GPL-3.0-or-later
"""Control vertices that may move: within a tolerance, against weights, or by epsilon afterwards."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight
from moving import icosphere
from refusing import refusal
from surfaces import boundary_vertices, output_faces

NAMES = ("icosahedron", "creature", "wavy_patch", "torus_quads", "random_hull", "house")
SMOOTH = [name for name in NAMES if name != "random_hull"]
STEPS = {"energy": "total_curvature"}
PADS = {"pad_size": 0.5}
EXACT = {"interpolation": "exact"}
UNIFORM = {"metric_exponent": 0.0}  # such charts depend on no position


def moved(result, vertices) -> np.ndarray:
    """How far each control vertex is from its place."""
    return np.linalg.norm(result.vertices[: len(vertices)] - vertices, axis=1)


def thin_plate(result) -> float:
    return result.report["energy"]["result"]["thin_plate"]


def bent(result) -> float:
    """The total curvature at the end of the steps."""
    return result.report["curvature"][-1]["energy"]


def near(mesh, levels=2, **options):
    return tight.fair(*mesh, levels, **{"interpolation": "approximate"} | options)


@pytest.mark.parametrize(
    "name, tolerance, options",
    [
        (name, tolerance, {"pad_size": size} | energy)
        for energy, sizes, names, tolerances in (
            ({}, (0.0, 0.5), NAMES, (1e-6, 1e-3, 0.03, 0.3, 1.0)),
            (STEPS, (0.0, 1.0), SMOOTH, (1e-3, 0.03, 0.1)),
        )
        for size in sizes
        for name in names
        for tolerance in tolerances
    ],
    ids=str,
)
def test_no_vertex_moves_further_than_the_tolerance(name, tolerance, options):
    vertices, faces = meshes.ALL[name]()
    result = near((vertices, faces), tolerance=tolerance, **options)
    report, distance = result.report, moved(result, vertices)
    assert distance.max() <= tolerance
    assert report["largest_deviation"] == pytest.approx(distance.max(), rel=1e-9)
    assert report["converged"]
    if "energy" in options:
        assert report["constraint_gap"] == report["curvature"][-1]["constraint_gap"] <= 1e-4
        return
    assert report["constraint_gap"] <= (1e-4 if options["pad_size"] else 1e-3)
    assert report["constraint_rounds"] > 0
    if (
        options["pad_size"] and tolerance < 1
    ):  # else no load is left that a force could be a share of
        assert report["levels"][-1]["pad_force"] <= 2e-3


@pytest.mark.parametrize("name", NAMES)
def test_more_tolerance_less_energy(name):
    mesh = meshes.ALL[name]()
    energies = [thin_plate(near(mesh, tolerance=t)) for t in (0.0, 1e-4, 1e-2, 0.1, 0.3)]
    assert all(more < less for less, more in zip(energies, energies[1:]))
    assert energies[0] == thin_plate(tight.fair(*mesh, 2))


def test_the_least_energy_within_the_tolerance():
    """No other point in the balls is better: other allowed control positions, interpolated, cost as much or more."""
    vertices, faces = meshes.ALL["three_handles"]()  # no folds, whose repair would cost energy
    tolerance = 0.05
    result = near((vertices, faces), tolerance=tolerance, **UNIFORM)
    best, gap = thin_plate(result), result.report["constraint_gap"]
    assert gap <= 1e-3
    offset = result.vertices[: len(vertices)] - vertices

    def held(offset):
        return thin_plate(tight.fair(vertices + offset, faces, 2, **UNIFORM))

    assert held(offset) == pytest.approx(best, rel=1e-5)
    assert held(0.95 * offset) > best
    random = np.random.default_rng(0)
    for size in (1e-3, 1e-2, 3e-2):
        other = offset + size * random.normal(size=offset.shape)
        other *= np.minimum(1, tolerance / np.linalg.norm(other, axis=1))[:, None]
        assert held(other) >= best * (1 - 2 * gap)


@pytest.mark.parametrize(
    "name, options",
    [(name, {"pad_size": size}) for size in (0.0, 0.5) for name in NAMES]
    + [("creature", STEPS | {"pad_size": 1.0})],
    ids=str,
)
def test_more_weight_is_closer(name, options):
    vertices, faces = meshes.ALL[name]()
    runs = [
        near((vertices, faces), weights=np.full(len(vertices), w), **options)
        for w in (1e-2, 1.0, 1e2, 1e4, 1e6)[len(options) - 1 :]
    ]
    farthest = [moved(r, vertices).max() for r in runs]
    assert all(near < 0.9 * far for far, near in zip(farthest, farthest[1:]))
    assert farthest[-1] < 1e-4 and all(r.report["converged"] for r in runs)
    exact = near((vertices, faces), **EXACT, **options)
    if "energy" in options:
        assert bent(runs[-1]) == pytest.approx(bent(exact), rel=1e-3)
        return
    assert all(less < more for less, more in zip(map(thin_plate, runs), map(thin_plate, runs[1:])))
    assert thin_plate(runs[-1]) < thin_plate(exact)
    assert np.abs(runs[-1].vertices - exact.vertices).max() < 1e-3


def test_weights_are_one_a_vertex():
    """An infinite weight holds a vertex to the last bit, zero leaves it free, and a larger weight pulls it nearer."""
    vertices, faces = meshes.creature()
    weights = np.full(len(vertices), np.inf)
    weights[:3] = 0
    free = near((vertices, faces), weights=weights)
    assert np.array_equal(free.vertices[3 : len(vertices)], vertices[3:])
    assert (moved(free, vertices)[:3] > 1e-3).all()
    weights[0] = 30.0
    pulled = near((vertices, faces), weights=weights)
    assert 0 < moved(pulled, vertices)[0] < 0.9 * moved(free, vertices)[0]
    assert thin_plate(free) < thin_plate(pulled) < thin_plate(tight.fair(vertices, faces, 2))


@pytest.mark.parametrize(
    "option", [{"tolerance": 0.1}, {"weights": np.ones(25)}, EXACT | {"epsilon": 0.1}], ids=str
)
def test_vertices_on_curves_stay(option):
    vertices, faces = meshes.wavy_patch()
    exact = tight.fair(vertices, faces, 2)
    result = near((vertices, faces), **option)
    rim = boundary_vertices(output_faces(result))
    assert result.vertices[rim].tobytes() == exact.vertices[rim].tobytes()
    inside = np.setdiff1d(np.arange(len(vertices)), rim)
    assert (moved(result, vertices)[inside] > 1e-3).all()


@pytest.mark.parametrize("name", NAMES)
def test_epsilon_takes_cusps_off(name):
    """No vertex moves farther than epsilon; the energy falls, the more the larger; 0: nothing."""
    vertices, faces = meshes.ALL[name]()
    exact, energies = tight.fair(vertices, faces, 2), []
    for epsilon in (0, 1e-3, 1e-2, 1e-1):
        result = tight.fair(vertices, faces, 2, epsilon=epsilon)
        farthest = moved(result, vertices).max()
        assert farthest <= epsilon and (farthest > 0) == (epsilon > 0)
        assert result.report["largest_deviation"] == pytest.approx(farthest, rel=1e-9)
        assert epsilon > 0 or np.array_equal(result.vertices, exact.vertices)
        energies.append(thin_plate(result))
    assert all(more < less for less, more in zip(energies, energies[1:]))


def test_weights_that_leave_a_closed_surface_nowhere_to_be():
    """Nothing holds it, so any single point would do, and that is no surface."""
    error = refusal(near, meshes.icosahedron(), weights=np.zeros(12))
    assert error.code == "UNDERDETERMINED" and error.elements == list(range(12))


def test_a_flat_mesh_with_a_tolerance_has_nothing_to_settle():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    report = near((vertices, [[0, 1, 2, 3]]), boundary="free", tolerance=0.1).report
    assert report["constraint_gap"] <= 1e-3 and report["largest_deviation"] <= 1e-9


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature"])
def test_each_vertex_has_a_tolerance_of_its_own(energy):
    """Zero holds a vertex to the last bit; with infinity it goes where the surface bends least."""
    vertices, faces = meshes.creature()
    each = np.linspace(0.002, 0.05, len(vertices))
    each[5:9], each[20] = 0, np.inf
    distance = moved(near((vertices, faces), tolerance=each, energy=energy), vertices)
    assert (distance <= each).all() and (distance[5:9] == 0).all()
    bound = np.isfinite(each) & (each > 0)
    assert np.median(distance[bound] / each[bound]) > 0.99
    assert distance[20] > 0.05


@pytest.mark.parametrize("name", NAMES)
def test_what_cannot_move_is_interpolated(name):
    vertices, faces = meshes.ALL[name]()
    count = len(vertices)
    for pads, option in (
        (PADS, {}),
        (PADS, {"tolerance": 0}),
        (PADS, {"tolerance": np.zeros(count)}),
        (PADS, {"weights": np.full(count, np.inf)}),
        ({}, {"weights": np.full(count, 10.0), "tolerance": np.zeros(count)}),
    ):
        exact = tight.fair(vertices, faces, 2, **pads).vertices
        assert np.array_equal(near((vertices, faces), **option, **pads).vertices, exact)


@pytest.mark.parametrize("option", [{"tolerance": 0.02}, {"weights": np.full(98, 30.0)}], ids=str)
def test_no_force_is_left_at_a_point(option):
    """Interpolated on pads, at the places where the vertices went, they give the same surface."""
    vertices, faces = meshes.creature()
    uniform = {"relative_residual": 1e-10, **UNIFORM}
    loose = near((vertices, faces), **option, **uniform, **PADS)
    there = loose.vertices[: len(vertices)]
    to_pads, to_points = (
        np.abs(tight.fair(there, faces, 2, **pads, **uniform).vertices - loose.vertices).max()
        for pads in (PADS, {})
    )
    assert to_points > 1e-3 * np.ptp(vertices, axis=0).max()
    assert to_pads < 0.3 * to_points


@pytest.mark.parametrize("refined, tolerance", [(1, 0.2), (2, 0.03), (2, 0.06), (2, 0.2)])
def test_a_sphere_shrinks_as_a_whole(refined, tolerance):
    """All vertices move together, in waves that the surface hardly resists; soft springs overshoot there. One
    allowed surface is that through the vertices, scaled to the inner ends of the balls."""
    points, faces = icosphere(refined)
    through = tight.fair(points, faces, 2, **PADS)
    result = near((points, faces), tolerance=tolerance, **PADS)
    assert result.report["converged"]
    assert thin_plate(result) <= (1 - tolerance) ** 2 * thin_plate(through) * (1 + 2e-4)


def test_steps_end_once_the_vertices_are_fixed():
    """Some pads are gone, some unknowns fixed; once steps were 3e-3 off, or taken back."""
    vertices, faces = meshes.random_hull(90, seed=3)
    bumps = 1 + 0.1 * np.random.default_rng(3).normal(size=(len(vertices), 1))
    options = {"interpolation": "approximate", "tolerance": 0.06}
    finest = df.fair(bumps * vertices, faces, 2, **STEPS, **options).report["curvature"][-1]
    assert finest["damped"] and finest["converged"] and finest["left"] <= 1e-5
