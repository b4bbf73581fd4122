# SPDX-License-Identifier: GPL-3.0-or-later
"""Fillings of ragged holes, and beside what is in their way."""

import random

import discrete_fairing as df
import numpy as np
import pytest
from discrete_fairing.holes import crossings
from lattices import lattice_faces
from ragged_holes import cut, ragged, smallest_angle, torus, uses


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


def half_ball(centre, n=24, rings=10):
    """The lower half of a sphere with the radius 1, in triangles."""
    down = np.linspace(np.pi / 2, np.pi, rings + 1)[:-1]
    around = np.linspace(0, 2 * np.pi, n, endpoint=False)
    d, a = np.meshgrid(down, around, indexing="ij")
    points = np.stack([np.sin(d) * np.cos(a), np.sin(d) * np.sin(a), np.cos(d)], -1).reshape(-1, 3)
    cells = lattice_faces(rings, n, (False, True))
    last = cells[-n:, [1, 2]]
    pole = np.insert(last, 1, rings * n, axis=1)
    faces = np.concatenate([cells[:, :3], cells[:, [0, 2, 3]], pole])
    return np.concatenate([points, [[0, 0, -1]]]) + centre, faces


def with_square(height):
    """Half a sphere, whose rim is at 0, and a square above it; and the hole."""
    points, faces = half_ball([0, 0, 0])
    square = np.array([[-3, -3, height], [3, -3, height], [3, 3, height], [-3, 3, height]])
    count = len(points)
    beside = [[count, count + 1, count + 2], [count, count + 2, count + 3]]
    return np.concatenate([points, square]), np.concatenate([faces, beside]), np.arange(24)


def test_a_flatter_filling_stays_below_what_is_in_the_way():
    """Total curvature would make a dome of height 1, the thin plate is lower."""
    points, faces, hole = with_square(0.8)
    filled = df.fill_holes(points, faces, holes=[hole])
    (report,) = filled.holes
    assert report.energy == "thin_plate" and report.crossings == 0 and report.folds == 0
    assert 0 < filled.vertices[len(points) :, 2].max() < 0.8


def test_what_crosses_all_the_same_is_told():
    """A needle stands in the middle of the hole."""
    points, faces, hole = with_square(1.5)
    needle = np.array([[0.1, 0, -0.5], [0.1, 0, 1.4], [0.12, 0.02, 1.4]])
    faces = np.concatenate([faces, [len(points) + np.arange(3)]])
    points = np.concatenate([points, needle])
    (report,) = df.fill_holes(points, faces, holes=[hole]).holes
    assert report.crossings > 0


def test_two_fillings_do_not_cross():
    """Two halves of spheres stand mouth to mouth, nearer than twice their radius: one filling gives way."""
    points, faces = half_ball([0, 0, 0])
    other = points * [1, 1, -1] + [0, 0, 1.7]
    both = np.concatenate([points, other])
    all_faces = np.concatenate([faces, faces[:, ::-1] + len(points)])
    holes = df.find_holes(both, all_faces)
    assert len(holes) == 2
    filled = df.fill_holes(both, all_faces)
    assert [hole.crossings for hole in filled.holes] == [0, 0]
    assert {hole.energy for hole in filled.holes} == {"total_curvature", "thin_plate"}


def test_the_count_is_that_of_the_definition():
    """It is compared with all pairs of triangles, at random."""
    random = np.random.default_rng(3)
    corner = random.uniform(0, 1, (80, 1, 3)) + random.uniform(-0.15, 0.15, (80, 3, 3))
    points, triangles = corner.reshape(-1, 3), np.arange(240, dtype=np.int32).reshape(-1, 3)
    ends = np.roll(corner, -1, axis=1)
    meet = pierced(corner[:, None], ends[:, None], corner[None, :, None]).any(axis=2)
    np.fill_diagonal(meet, False)
    meet |= meet.T
    assert 10 < meet.any(axis=0).sum() < 70
    native = crossings._native
    for first in (0, 30):
        found = native._crossings(points, triangles, first, native.Monitor(), None)
        assert found.tolist() == (first + np.flatnonzero(meet[first:].any(axis=1))).tolist()


def pierced(start, end, triangle):
    """Whether the line between the ends (…, 3) passes through the triangles (…, 1, 3, 3), by volumes."""

    def volume(p, q, r, s):
        return np.linalg.det(np.stack(np.broadcast_arrays(q - p, r - p, s - p), axis=-2))

    a, b, c = np.moveaxis(triangle, -2, 0)
    apart = volume(a, b, c, start) * volume(a, b, c, end) < 0
    turns = np.stack([volume(start, end, *pair) > 0 for pair in ((a, b), (b, c), (c, a))])
    return apart & (turns.all(axis=0) | ~turns.any(axis=0))
