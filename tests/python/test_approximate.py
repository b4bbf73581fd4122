# SPDX-License-Identifier: GPL-3.0-or-later
"""Control vertices that may move: within a tolerance, against weights, or by epsilon afterwards."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight
from surfaces import boundary_vertices, output_faces

NAMES = ("icosahedron", "creature", "wavy_patch", "torus_quads", "random_hull", "house")


def moved(result, vertices) -> np.ndarray:
    """How far each control vertex is from its place."""
    return np.linalg.norm(result.vertices[: len(vertices)] - vertices, axis=1)


def thin_plate(result) -> float:
    return result.report["energy"]["result"]["thin_plate"]


def approximate(mesh, levels=2, **options):
    return tight.fair(*mesh, levels, interpolation="approximate", **options)


@pytest.mark.parametrize("pad_size", [0.0, 0.5])
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("tolerance", [1e-6, 1e-3, 0.03, 0.3, 1.0])
def test_no_vertex_moves_further_than_the_tolerance(name, tolerance, pad_size):
    vertices, faces = meshes.ALL[name]()
    result = approximate((vertices, faces), tolerance=tolerance, pad_size=pad_size)
    distance = moved(result, vertices)
    assert distance.max() <= tolerance
    assert result.report["largest_deviation"] == pytest.approx(distance.max(), rel=1e-9)
    assert result.report["constraint_gap"] <= (1e-4 if pad_size else 1e-3)
    assert result.report["converged"] and result.report["constraint_rounds"] > 0
    if pad_size and tolerance < 1:  # else no load is left that a force could be a share of
        assert result.report["levels"][-1]["pad_force"] <= 2e-3


@pytest.mark.parametrize("name", NAMES)
def test_more_tolerance_less_energy(name):
    mesh = meshes.ALL[name]()
    energies = [thin_plate(approximate(mesh, tolerance=t)) for t in (0.0, 1e-4, 1e-2, 0.1, 0.3)]
    assert all(more < less for less, more in zip(energies, energies[1:]))
    assert energies[0] == thin_plate(tight.fair(*mesh, 2))


def test_the_least_energy_within_the_tolerance():
    """No better point in the ball: other feasible control positions, interpolated, cost more or as
    much.

    Uniform charts depend on no position, so the energies of the two runs are one functional.
    """
    vertices, faces = meshes.ALL["three_handles"]()  # no folds, whose repair would cost energy
    tolerance, uniform = 0.05, {"metric_exponent": 0.0}
    result = approximate((vertices, faces), 2, tolerance=tolerance, **uniform)
    best, gap = thin_plate(result), result.report["constraint_gap"]
    assert gap <= 1e-3
    offset = result.vertices[: len(vertices)] - vertices
    held = tight.fair(vertices + offset, faces, 2, **uniform)
    assert thin_plate(held) == pytest.approx(best, rel=1e-5)
    random = np.random.default_rng(0)
    for size in (1e-3, 1e-2, 3e-2):
        other = offset + size * random.normal(size=offset.shape)
        other *= np.minimum(1, tolerance / np.linalg.norm(other, axis=1))[:, None]
        assert thin_plate(tight.fair(vertices + other, faces, 2, **uniform)) >= best * (1 - 2 * gap)
    shrunk = tight.fair(vertices + 0.95 * offset, faces, 2, **uniform)
    assert thin_plate(shrunk) > best


@pytest.mark.parametrize("pad_size", [0.0, 0.5])
@pytest.mark.parametrize("name", NAMES)
def test_more_weight_is_closer(name, pad_size):
    vertices, faces = meshes.ALL[name]()
    runs = [
        approximate((vertices, faces), weights=np.full(len(vertices), w), pad_size=pad_size)
        for w in (1e-2, 1.0, 1e2, 1e4, 1e6)
    ]
    farthest = [moved(r, vertices).max() for r in runs]
    assert all(near < 0.9 * far for far, near in zip(farthest, farthest[1:]))
    assert all(less < more for less, more in zip(map(thin_plate, runs), map(thin_plate, runs[1:])))
    assert farthest[-1] < 1e-4 and all(r.report["converged"] for r in runs)
    exact = tight.fair(vertices, faces, 2, pad_size=pad_size)
    assert thin_plate(runs[-1]) < thin_plate(exact)
    assert np.abs(runs[-1].vertices - exact.vertices).max() < 1e-3


def test_weights_are_one_a_vertex():
    """Infinite: stays to the last bit. Zero: goes where the surface likes it best. One more: nearer
    by itself."""
    vertices, faces = meshes.creature()
    weights = np.full(len(vertices), np.inf)
    weights[:3] = 0
    free = approximate((vertices, faces), weights=weights)
    assert np.array_equal(free.vertices[3 : len(vertices)], vertices[3:])
    assert (moved(free, vertices)[:3] > 1e-3).all()
    weights[0] = 30.0
    pulled = approximate((vertices, faces), weights=weights)
    assert 0 < moved(pulled, vertices)[0] < 0.9 * moved(free, vertices)[0]
    assert thin_plate(free) < thin_plate(pulled) < thin_plate(tight.fair(vertices, faces, 2))


def test_a_free_vertex_does_not_matter():
    """With uniform charts its place is nothing to the surface."""
    vertices, faces = meshes.cut_quads(meshes.torus())
    weights = np.full(len(vertices), np.inf)
    weights[7] = 0
    there = vertices.copy()
    there[7] += [0.2, -0.1, 0.3]
    options = {"weights": weights, "metric_exponent": 0.0, "relative_residual": 1e-12}
    a, b = (approximate((v, faces), **options).vertices for v in (vertices, there))
    assert np.abs(a - b).max() < 1e-9


@pytest.mark.parametrize(
    "option", [{"tolerance": 0.1}, {"weights": 1.0}, {"epsilon": 0.1}], ids=str
)
def test_vertices_on_curves_stay(option):
    vertices, faces = meshes.wavy_patch()
    if "weights" in option:
        option = {"weights": np.full(len(vertices), option["weights"])}
    exact = tight.fair(vertices, faces, 2)
    mode = "exact" if "epsilon" in option else "approximate"
    result = tight.fair(vertices, faces, 2, interpolation=mode, **option)
    rim = boundary_vertices(output_faces(result))
    assert result.vertices[rim].tobytes() == exact.vertices[rim].tobytes()
    distance = moved(result, vertices)
    inside = np.setdiff1d(np.arange(len(vertices)), rim)
    assert (distance[inside] > 1e-3).all()


@pytest.mark.parametrize("name", NAMES)
def test_epsilon_takes_cusps_off(name):
    """No control vertex further than epsilon; energy falls, the more the larger epsilon; 0 does
    nothing."""
    vertices, faces = meshes.ALL[name]()
    energies = [thin_plate(tight.fair(vertices, faces, 2))]
    for epsilon in (1e-3, 1e-2, 1e-1):
        result = tight.fair(vertices, faces, 2, epsilon=epsilon)
        assert 0 < moved(result, vertices).max() <= epsilon
        assert result.report["largest_deviation"] == pytest.approx(
            moved(result, vertices).max(), rel=1e-9
        )
        energies.append(thin_plate(result))
    assert all(more < less for less, more in zip(energies, energies[1:]))
    assert np.array_equal(
        tight.fair(vertices, faces, 2, epsilon=0).vertices, tight.fair(vertices, faces, 2).vertices
    )


def test_epsilon_leaves_creases_alone():
    (vertices, faces), ridge = meshes.roof()
    result = tight.fair(vertices, faces, 2, epsilon=0.05, crease_edges=ridge)
    on_ridge = np.unique(ridge)
    assert np.array_equal(result.vertices[on_ridge], vertices[on_ridge])


def test_weights_that_leave_a_closed_surface_nowhere_to_be():
    """Nothing holds it: any one point would do, and that is no surface."""
    with pytest.raises(df.FairingError) as caught:
        tight.fair(*meshes.icosahedron(), 2, interpolation="approximate", weights=np.zeros(12))
    assert caught.value.code == "UNDERDETERMINED" and caught.value.elements == list(range(12))


def test_a_flat_mesh_with_a_tolerance_has_nothing_to_settle():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    report = tight.fair(
        vertices, [[0, 1, 2, 3]], 2, boundary="free", interpolation="approximate", tolerance=0.1
    ).report
    assert report["constraint_gap"] <= 1e-3 and report["largest_deviation"] <= 1e-9


def test_back_leg_interpolates_only():
    with pytest.raises(df.FairingError, match="back_leg"):
        tight.fair(*meshes.cube(), 2, method="back_leg", interpolation="approximate", tolerance=0.1)


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature"])
def test_each_vertex_has_a_tolerance_of_its_own(energy):
    """Zero: stays to the last bit. Infinity: goes where the surface likes it best."""
    vertices, faces = meshes.creature()
    each = np.linspace(0.002, 0.05, len(vertices))
    each[5:9], each[20] = 0, np.inf
    distance = moved(approximate((vertices, faces), tolerance=each, energy=energy), vertices)
    assert (distance <= each).all() and (distance[5:9] == 0).all()
    bound = np.isfinite(each) & (each > 0)
    assert np.median(distance[bound] / each[bound]) > 0.99
    assert distance[20] > 0.05


def test_one_number_is_that_number_for_each():
    vertices, faces = meshes.creature()
    one = approximate((vertices, faces), tolerance=0.02)
    each = approximate((vertices, faces), tolerance=np.full(len(vertices), 0.02))
    assert np.array_equal(one.vertices, each.vertices)


def test_an_infinite_tolerance_leaves_a_vertex_to_its_weight():
    vertices, faces = meshes.creature()
    weights = np.full(len(vertices), 10.0)
    alone = approximate((vertices, faces), weights=weights)
    unbound = np.full(len(vertices), np.inf)
    both = approximate((vertices, faces), weights=weights, tolerance=unbound)
    assert np.array_equal(alone.vertices, both.vertices)
    assert both.report["constraint_rounds"] == 0
    none = approximate((vertices, faces), weights=weights, tolerance=np.zeros(len(vertices)))
    assert np.array_equal(none.vertices, tight.fair(vertices, faces, 2).vertices)


@pytest.mark.parametrize(
    "each, code",
    [
        (np.full(11, 0.1), "BAD_OPTION"),
        ([0.1], "BAD_SHAPE"),
        (np.full((12, 1), 0.1), "BAD_SHAPE"),
        ([[0.1], [0.1, 0.2]], "BAD_SHAPE"),
        (["a"] * 12, "BAD_SHAPE"),
    ],
    ids=str,
)
def test_tolerances_of_another_shape_are_refused(each, code):
    with pytest.raises(df.FairingError, match="tolerance") as caught:
        approximate(meshes.icosahedron(), tolerance=each)
    assert caught.value.code == code


@pytest.mark.parametrize("bad", [-1e-9, np.nan])
def test_a_bad_tolerance_is_named(bad):
    each = np.full(12, 0.1)
    each[[4, 7]] = bad
    with pytest.raises(df.FairingError) as caught:
        approximate(meshes.icosahedron(), tolerance=each)
    assert caught.value.code == "BAD_OPTION" and caught.value.elements == [4, 7]
