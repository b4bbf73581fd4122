# SPDX-License-Identifier: GPL-3.0-or-later
"""Fairing commutes with rigid motion, scaling, relabelling and mirroring, to 1e-9 of the size."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight
from surfaces import as_lists, assert_same_points, random_rotation, size_of

TOLERANCE = 1e-9
CASES = [(name, exponent) for name in sorted(meshes.ALL) for exponent in (0.5, 1.0, 0.0)]
OPTIONS = [
    {"chart": "tangent"},
    {"chart_blend": 0.5},
    {"boundary": "linear"},
    {"boundary": "free"},
    {"crease_angle": 0.9},
    {"corner_angle": 0.7},
]


def relabelled(vertices, faces, seed=0):
    """Vertices and faces in another order, every face beginning elsewhere, and where each vertex
    went."""
    random = np.random.default_rng(seed)
    place = random.permutation(len(vertices))
    moved = np.empty_like(vertices)
    moved[place] = vertices
    turned = []
    for face in as_lists(faces):
        start = random.integers(len(face))
        turned.append([int(place[v]) for v in face[start:] + face[:start]])
    return moved, [turned[f] for f in random.permutation(len(turned))], place


def assert_same_surface(found, expected, size):
    assert_same_points(found, expected, TOLERANCE * size)


@pytest.mark.parametrize("name, exponent", CASES)
def test_rigid_motion(name, exponent):
    vertices, faces = meshes.ALL[name]()
    rotation, shift = random_rotation(1), np.array([0.3, -5.0, 2.0])
    still = tight.fair(vertices, faces, 2, metric_exponent=exponent)
    moved = tight.fair(vertices @ rotation.T + shift, faces, 2, metric_exponent=exponent)
    difference = np.abs(moved.vertices - (still.vertices @ rotation.T + shift)).max()
    assert difference <= TOLERANCE * size_of(vertices)


@pytest.mark.parametrize("name, exponent", CASES)
@pytest.mark.parametrize("scale", [1e-6, 0.37, 1e6])
def test_scaling(name, exponent, scale):
    vertices, faces = meshes.ALL[name]()
    plain = tight.fair(vertices, faces, 2, metric_exponent=exponent)
    scaled = tight.fair(scale * vertices, faces, 2, metric_exponent=exponent)
    assert np.abs(scaled.vertices / scale - plain.vertices).max() <= TOLERANCE * size_of(vertices)


@pytest.mark.parametrize("exponent", [0.0, 0.5, 1.0])
def test_energies_scale_as_documented(exponent):
    """The thin-plate energy has unit length**(2 - 2 exponent); total curvature is a pure number."""
    vertices, faces = meshes.creature()
    one, two = (
        tight.fair(s * vertices, faces, 2, metric_exponent=exponent).report["energy"]
        for s in (1, 1e3)
    )
    for surface in ("result", "polyhedron", "prediction"):
        expected = one[surface]["thin_plate"] * 1e3 ** (2 - 2 * exponent)
        assert two[surface]["thin_plate"] == pytest.approx(expected, rel=1e-6)
        assert two[surface]["total_curvature"] == pytest.approx(
            one[surface]["total_curvature"], rel=1e-6
        )


@pytest.mark.parametrize("name, exponent", CASES)
def test_relabelling(name, exponent):
    vertices, faces = meshes.ALL[name]()
    plain = tight.fair(vertices, faces, 2, metric_exponent=exponent)
    moved, turned, _ = relabelled(vertices, faces)
    other = tight.fair(moved, turned, 2, metric_exponent=exponent)
    assert_same_surface(other.vertices, plain.vertices, size_of(vertices))


@pytest.mark.parametrize("name", ["single_triangle", "grid"])
def test_rounding_decides_nothing_on_flat_meshes(name):
    """Of two flat surfaces neither bends less: the start and the pads are not to hang on rounding."""
    vertices, faces = meshes.ALL[name]()
    vertices = vertices * [1, 1, 0]
    plain = df.fair(vertices, faces, 2, energy="total_curvature")
    for seed in range(3):
        turn = random_rotation(seed)
        moved, turned, _ = relabelled(vertices @ turn.T, faces, seed)
        other = df.fair(moved, turned, 2, energy="total_curvature")
        assert_same_points(other.vertices @ turn, plain.vertices, TOLERANCE * size_of(vertices))


@pytest.mark.parametrize("name, exponent", CASES)
def test_mirroring(name, exponent):
    vertices, faces = meshes.ALL[name]()
    plain = tight.fair(vertices, faces, 2, metric_exponent=exponent)
    mirrored = tight.fair(
        vertices * [-1, 1, 1], [f[::-1] for f in as_lists(faces)], 2, metric_exponent=exponent
    )
    assert_same_surface(mirrored.vertices * [-1, 1, 1], plain.vertices, size_of(vertices))


@pytest.mark.parametrize("option", OPTIONS, ids=str)
@pytest.mark.parametrize("name", ["creature", "wavy_patch", "roof"])
def test_every_option_commutes_too(name, option):
    vertices, faces = meshes.ALL[name]()
    size = size_of(vertices)
    plain = tight.fair(vertices, faces, 2, **option).vertices
    rotation = random_rotation(4)
    rotated = tight.fair(7.0 * vertices @ rotation.T, faces, 2, **option).vertices
    assert np.abs(rotated / 7.0 @ rotation - plain).max() <= TOLERANCE * size
    moved, turned, _ = relabelled(vertices, faces, 2)
    assert_same_surface(tight.fair(moved, turned, 2, **option).vertices, plain, size)
    reversed_faces = [f[::-1] for f in as_lists(faces)]
    mirrored = tight.fair(vertices * [1, -1, 1], reversed_faces, 2, **option).vertices
    assert_same_surface(mirrored * [1, -1, 1], plain, size)


def test_creases_and_corners_are_relabelled_along():
    (vertices, faces), creases = meshes.box_with_creases()
    plain = tight.fair(vertices, faces, 2, crease_edges=creases, corner_vertices=[9, 20])
    moved, turned, place = relabelled(vertices, faces)
    swapped = place[creases][::-1, ::-1]
    other = tight.fair(moved, turned, 2, crease_edges=swapped, corner_vertices=place[[20, 9]])
    assert_same_surface(other.vertices, plain.vertices, size_of(vertices))


def test_weights_and_tolerance_commute_with_scaling():
    vertices, faces = meshes.creature()
    weights = np.random.default_rng(0).uniform(0.1, 20, len(vertices))
    options = [
        lambda scale: {"weights": weights},
        lambda scale: {"tolerance": 0.05 * scale},
    ]
    for option in options:
        plain, scaled = (
            tight.fair(s * vertices, faces, 2, interpolation="approximate", **option(s)).vertices
            / s
            for s in (1, 1e4)
        )
        assert np.abs(scaled - plain).max() <= TOLERANCE * size_of(vertices)
