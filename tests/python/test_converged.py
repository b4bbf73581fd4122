# SPDX-License-Identifier: GPL-3.0-or-later
"""Converged: as near to the solution as promised; what has not converged is said."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from sliver_meshes import prism, stretched_sheet
from surfaces import size_of

STEPS = ["total_curvature", "minimum_variation"]
TIGHT = {"step_tolerance": 1e-11, "max_steps": 60}


def rough_torus(noise: float = 0.15, seed: int = 0):
    """Even quads, their vertices shaken."""
    points, faces = meshes.torus(8, 6)
    return points + noise * np.random.default_rng(seed).normal(size=points.shape), faces


WILD = {
    **{f"torus {n} {s}": rough_torus(n, s) for n in (0.1, 0.2, 0.3) for s in range(2)},
    "prism": prism(40),
    "sheet": stretched_sheet(60, 30),
    "sheared": stretched_sheet(60, 30, sheared=True),
}


def told(result) -> list[str]:
    return [
        w["message"] for w in result.report["warnings"] if w["code"].startswith("NOT_CONVERGED")
    ]


def assert_honest(result):
    """The report says the truth about each level and about the surface."""
    finest = result.report["curvature"][-1]
    assert result.report["converged"] == finest["converged"] == (not told(result))
    assert all(f"level {finest['level']}" in message for message in told(result))
    for level in result.report["curvature"]:
        assert not (level["converged"] and level["kept_start"])
        assert not level["converged"] or np.isfinite(level["left"])
        if level["start_variation"] > 0:
            worse = level["variation"] > 1.02 * level["start_variation"] + 1e-3
        else:
            worse = level["energy"] > 1.0101 * level["start_energy"] and not level["kept_start"]
        assert level["converged"] or not worse, "the start is kept"


@pytest.mark.parametrize("noise, seed", [(0.1, 0), (0.1, 1), (0.1, 2), (0.15, 3)])
@pytest.mark.parametrize("pad_size", [0.0, 1.0])
def test_a_tighter_surface_is_the_same_or_says_so(noise, seed, pad_size):
    mesh = rough_torus(noise, seed)
    usual, tight = (
        df.fair(*mesh, 3, energy="total_curvature", pad_size=pad_size, **options)
        for options in ({}, TIGHT)
    )
    for result in (usual, tight):
        assert_honest(result)
    finest = tight.report["curvature"][-1]
    assert finest["converged"] == (finest["left"] <= TIGHT["step_tolerance"])
    if usual.report["converged"] and tight.report["converged"]:
        away = np.abs(usual.vertices - tight.vertices).max()
        assert away <= 1e-5 * size_of(mesh[0])


@pytest.mark.parametrize("energy", STEPS)
@pytest.mark.parametrize("name", WILD)
def test_wild_meshes_say_how_they_ended(name, energy):
    assert_honest(df.fair(*WILD[name], 2, energy=energy))


@pytest.mark.parametrize("energy", STEPS)
def test_steps_that_are_cut_short_are_told(energy):
    result = df.fair(*meshes.creature(), 2, energy=energy, max_steps=1)
    assert not result.report["converged"] and not result.report["curvature"][-1]["converged"]
    (message,) = told(result)
    assert "level 2" in message and "steps" in message


def test_shapes_are_told_too():
    points, faces = meshes.creature()
    result = df.fair(points, faces, 2, energy="total_curvature", shapes=[1.1 * points], max_steps=1)
    assert [shape["converged"] for shape in result.report["shapes"]] == [False]
    assert len(told(result)) == 2 and told(result)[1].startswith("Shape 0: ")


def vertex_normal(points, faces, vertex):
    """Of the control mesh: the sum over the faces around."""
    normal = np.zeros(3)
    for face in (list(face) for face in faces if vertex in face):
        k = face.index(vertex)
        to_next, to_last = points[face[(k + 1) % len(face)]], points[face[k - 1]]
        normal += np.cross(to_next - points[vertex], to_last - points[vertex])
    return normal / np.linalg.norm(normal)


def leaning(points, faces, degrees, seed):
    """Normals at half of the vertices, that far from the mesh's own."""
    random = np.random.default_rng(seed)
    normals = np.full(points.shape, np.nan)
    for vertex in random.choice(len(points), len(points) // 2, replace=False):
        own = vertex_normal(points, faces, vertex)
        across = np.cross(own, random.normal(size=3))
        across /= np.linalg.norm(across)
        angle = np.radians(degrees)
        normals[vertex] = np.cos(angle) * own + np.sin(angle) * across
    return normals


@pytest.mark.parametrize("name", ["creature", "torus_quads"])
@pytest.mark.parametrize("degrees", [30, 60, 79])
def test_a_normal_on_the_other_side_is_told(name, degrees):
    """Couples fix a plane, but not which side of it is outside."""
    points, faces = meshes.ALL[name]()
    turned = 0
    for seed in range(3):
        report = df.fair(points, faces, 2, normals=leaning(points, faces, degrees, seed)).report
        finest = report["levels"][-1]
        turned += finest["normal_angle"] > 90
        assert report["converged"] == (finest["normal_angle"] <= 0.05)
        assert finest["converged"] == report["converged"]
        why = "TURNED_OVER" if finest["normal_angle"] > 90 else "NORMALS"
        codes = [w["code"] for w in report["warnings"]]
        assert codes == ([] if report["converged"] else [f"NOT_CONVERGED_{why}"])
    assert turned > 0 or degrees < 79, "the case that this is about"
