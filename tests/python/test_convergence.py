# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver solves: residual, iterations, and that no other surface has less energy."""

import control_meshes as meshes
import numpy as np
import pytest
import tight

TRIANGLES = ("icosahedron", "octahedron", "tetrahedron", "random_hull", "torus_triangles")


def thin_plate(result) -> float:
    return result.report["energy"]["result"]["thin_plate"]


def uniform_energy(points, faces) -> float:
    """Thin-plate energy of a mesh as it is, in the metric in which every edge has length one."""
    return thin_plate(tight.fair(points, faces, 0, metric_exponent=0.0))


@pytest.mark.parametrize("name", sorted(meshes.ALL))
@pytest.mark.parametrize("exponent", [0.0, 0.5, 1.0])
def test_converges(name, exponent):
    report = tight.fair(*meshes.ALL[name](), 3, metric_exponent=exponent).report
    finest = report["levels"][-1]
    assert finest["level"] == 3 and finest["converged"] and report["converged"]
    assert finest["residual"] <= 1e-8
    assert finest["iterations"] <= 40
    assert report["iterations"] == [level["iterations"] for level in report["levels"]]
    assert report["residuals"] == [level["residual"] for level in report["levels"]]
    # the house's floor is wider than the house is high, and bulges
    assert {w["code"] for w in report["warnings"]} <= {"THICKNESS_CHANGED"}


def test_says_when_it_stops_early():
    report = tight.fair(*meshes.creature(), 3, max_iterations=2).report
    assert not report["converged"] and not report["levels"][-1]["converged"]
    (warning,) = report["warnings"]
    assert warning["code"] == "NOT_CONVERGED" and "stopped after 2 iterations" in warning["message"]
    assert "thin faces" not in warning["message"], "of even ones"


@pytest.mark.parametrize("name", sorted(set(meshes.ALL) - {"grid", "single_triangle"}))
@pytest.mark.parametrize("exponent", [0.5, 1.0])
def test_result_beats_prediction_beats_polyhedron(name, exponent):
    energy = tight.fair(*meshes.ALL[name](), 3, metric_exponent=exponent).report["energy"]
    result, prediction, polyhedron = (
        energy[k]["thin_plate"] for k in ("result", "prediction", "polyhedron")
    )
    assert 0 < result < prediction < polyhedron


# The random hull folds at this spacing, and folds are taken out at the cost of energy.
@pytest.mark.parametrize("name", [name for name in TRIANGLES if name != "random_hull"])
@pytest.mark.parametrize("levels", [1, 2, 3])
def test_energy_is_least(name, levels):
    """The uniform result, measured as a mesh of its own, has the reported energy and no slope."""
    vertices, faces = meshes.ALL[name]()
    result = tight.fair(vertices, faces, levels, metric_exponent=0.0, relative_residual=1e-12)
    here = uniform_energy(result.vertices, result.triangles)
    assert 4**levels * here == pytest.approx(thin_plate(result), rel=1e-10)
    random = np.random.default_rng(levels)
    for size in (1e-3, 1e-1):
        step = size * random.normal(size=result.vertices.shape)
        step[: len(vertices)] = 0
        ahead, behind = (
            uniform_energy(result.vertices + s * step, result.triangles) for s in (1, -1)
        )
        assert min(ahead, behind) > here
        assert abs(ahead - behind) <= 1e-7 * (ahead + behind - 2 * here) + 1e-11 * here


def test_the_papers_icosahedron():
    """Row one of mathematics.md, section 6: exponent 1, level 4."""
    result = tight.fair(*meshes.icosahedron(), 4, metric_exponent=1.0)
    radius = np.linalg.norm(result.vertices, axis=1)
    curvature = result.report["energy"]["result"]["total_curvature"] / (8 * np.pi)
    assert curvature == pytest.approx(1.154, abs=0.01)
    assert radius.min() == pytest.approx(0.952, abs=0.002) and radius.max() == pytest.approx(
        1.0, abs=1e-12
    )


@pytest.mark.parametrize("cut", [False, True])
def test_total_curvature_of_a_torus_is_its_own(cut):
    """Clifford's, eight pi squared, to second order."""
    errors = []
    for k in (1, 2, 4):
        mesh = meshes.torus(14 * k, 10 * k)
        report = tight.fair(*(meshes.cut_quads(mesh) if cut else mesh), 0).report
        errors.append(abs(report["energy"]["result"]["total_curvature"] / (8 * np.pi**2) - 1))
    assert errors[-1] < 5e-3
    assert np.log2(errors[-2] / errors[-1]) > 1.9


@pytest.mark.parametrize("name", ["random_hull", "torus_triangles", "wavy_patch", "cube"])
def test_the_papers_own_method_comes_down_to_the_same(name):
    """Refine and smooth: more sweeps, less energy, never less than the solution's."""
    vertices, faces = meshes.ALL[name]()
    least = thin_plate(tight.fair(vertices, faces, 2))
    energies = [
        thin_plate(tight.fair(vertices, faces, 2, method="back_leg", sweeps=sweeps))
        for sweeps in (1, 5, 50, 2000)
    ]
    assert energies == sorted(energies, reverse=True)
    assert energies[0] > 1.001 * least and energies[2] < energies[1]
    assert energies[-1] == pytest.approx(least, rel=1e-6) and energies[-1] >= least * (1 - 1e-9)
