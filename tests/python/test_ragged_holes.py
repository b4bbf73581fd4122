# SPDX-License-Identifier: GPL-3.0-or-later
"""Ragged holes get a manifold without folds, except those that any triangles over the rim would have."""

import random

import discrete_fairing as df
import numpy as np
import pytest
from mesh_files import read_mesh
from ragged_holes import cut, ragged, smallest_angle, torus, uses
from shared_data import SHARED


def assert_sound(vertices, faces, least_angle=0.0):
    """Closed, and folded only where the rim alone makes it so. Returns the holes."""
    filled = df.fill_holes(vertices, faces)
    assert smallest_angle(filled.vertices, filled.faces[filled.new_faces]) > least_angle
    assert (uses(filled.faces) == 2).all()
    assert not [d for d in df.check(filled.vertices, filled.faces) if d.severity == "error"]
    bare = df.fill_holes(vertices, faces, joint="position", density=0)
    for hole, plain in zip(filled.holes, bare.holes, strict=True):
        assert not hole.folds or plain.folds
    return filled.holes


@pytest.mark.parametrize("wander", [0.0, 0.9])
@pytest.mark.parametrize("seed", range(4))
def test_on_a_torus_total_curvature_closes_them_without_a_fold(seed, wander):
    """The mean of a vertex's neighbours often lies beyond such a rim, within the mesh."""
    rng = random.Random(seed)
    points, faces = torus(120, 60)
    taken = ragged(faces, rng.choice([100, 300, 900]), rng, wander)
    for hole in assert_sound(*cut(points, faces, taken), least_angle=15.0):
        assert (hole.energy, hole.joint) == ("total_curvature", "curvature")
        assert hole.converged and not hole.folds


REAL = [
    ("cages/trimesh__fuze.ply", 3, 60),
    ("cages/geometry-central__fox.ply", 0, 12),
    ("cages/odedstein-meshes__fish_fish_low_resolution.obj", 5, 90),
    ("mechanical/trimesh__round.stl", 27, 60),
    ("mechanical/cinolib__cube_minus_sphere.obj", 24, 90),
    ("mechanical/gpytoolbox__fandisk.obj", 1, 90),
]


@pytest.mark.parametrize("name, seed, size", REAL)
def test_real_meshes(name, seed, size):
    path = SHARED / "good" / name
    if not path.exists():
        pytest.skip("the collection of meshes is not here")
    points, polygons = read_mesh(path)
    triangles = np.array([t for p in polygons for t in zip([p[0]] * len(p), p[1:], p[2:])])
    assert_sound(*cut(points, triangles, ragged(triangles, size, random.Random(seed), 0.5)))


def ragged_end():
    """A torus without a part that begins at teeth: (points, faces, gone, i and j of the faces)."""
    points, faces = torus(96, 24)
    tooth = np.array([0, 5, 1, 7, 3, 8, 0, 6, 2, 7, 1, 4])
    i, j = np.divmod(faces[:, 0], 24)
    return points, faces, (i >= 40 + tooth[j % 12]) & (i < 70), i, j


def test_a_first_triangulation_that_folds_is_unfolded():
    """Triangles between the teeth alone fold back from their tips."""
    points, faces, gone, *_ = ragged_end()
    vertices, kept = cut(points, faces, gone)
    bare = df.fill_holes(vertices, kept, joint="position", density=0)
    assert any(hole.folds for hole in bare.holes)
    filled = df.fill_holes(vertices, kept)
    for hole in filled.holes:
        assert (hole.energy, hole.joint) == ("total_curvature", "curvature")
        assert (hole.converged, hole.folds, hole.crossings) == (True, 0, 0)
    assert (uses(filled.faces) == 2).all()
    assert smallest_angle(filled.vertices, filled.faces[filled.new_faces]) > 15


def test_holes_in_rounds_of_their_own_share_no_edge():
    """One hole is done after the first round; the other one, around the same vertices, is not."""
    points, faces, gone, i, j = ragged_end()
    vertices, kept = cut(points, faces, gone | ((i >= 36) & (i < 38) & (j < 9)))
    filled = df.fill_holes(vertices, kept)
    assert len(filled.holes) == 3 and (uses(filled.faces) == 2).all()
    assert not [d for d in df.check(filled.vertices, filled.faces) if d.severity == "error"]


def test_noise_at_a_rim_leaves_no_more_folds_than_any_triangles():
    """Noise is a third of an edge. Where a filling folds and bare triangles do not, bare triangles take its place."""
    rng = random.Random(0)
    points, faces = torus(120, 60)
    gone = np.any([ragged(faces, rng.choice([60, 150]), rng, 0.9) for _ in range(4)], axis=0)
    vertices, kept = cut(points, faces, gone)
    noise = 0.03 * np.random.default_rng(0).normal(size=vertices.shape)
    filled = df.fill_holes(vertices + noise, kept)
    assert len(filled.holes) == 4 and (uses(filled.faces) == 2).all()
    assert sum(hole.folds > 0 for hole in filled.holes) == 3
