# SPDX-License-Identifier: GPL-3.0-or-later
"""Fillings that would pass through the mesh, or through each other."""

from concurrent.futures import ThreadPoolExecutor

import discrete_fairing as df
import numpy as np
import pytest
from discrete_fairing import arrays, crossings
from lattices import lattice_faces
from refusing import refusal


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


def test_nothing_in_the_way():
    points, faces, hole = with_square(1.5)
    (report,) = df.fill_holes(points, faces, holes=[hole]).holes
    assert (report.energy, report.crossings) == ("total_curvature", 0)


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


@pytest.mark.parametrize(
    ("triangles", "first", "code"),
    [
        ([[0, 1, 2], [0, 1, 7]], 0, "INDEX_OUT_OF_RANGE"),
        ([[0, 1, -1], [0, 1, 2]], 0, "INDEX_OUT_OF_RANGE"),
        ([[0, 1, 2], [0, 1, 2]], 3, "BAD_SHAPE"),
    ],
)
def test_corners_that_do_not_exist_are_refused(triangles, first, code):
    """Memory beyond the points was once read."""
    native = crossings._native
    assert (
        refusal(
            native._crossings,
            np.eye(3),
            np.array(triangles, np.int32),
            first,
            native.Monitor(),
            None,
        ).code
        == code
    )


def test_calls_on_one_filler_wait_for_each_other():
    """Two threads once wrote over each other's holes, and the process ended."""
    native = crossings._native
    points, faces = half_ball([0, 0, 0])
    count = len(points)
    all_points = np.concatenate([points + [3 * i, 0, 0] for i in range(6)])
    all_faces = np.concatenate([faces + i * count for i in range(6)])
    filler = native.Filler(all_points, *arrays.face_arrays(all_faces))
    loops, _ = filler.find(native.Monitor(), None)

    def fill(holes):
        wanted = [[loop] for loop in loops[:holes]]
        found = [filler.fill(wanted, 1.0, False, native.Monitor(), None)[0] for _ in range(10)]
        return {len(fillings) for fillings in found}

    with ThreadPoolExecutor(6) as pool:
        assert list(pool.map(fill, range(1, 7))) == [{holes} for holes in range(1, 7)]


def pierced(start, end, triangle):
    """Whether the line between the ends (…, 3) passes through the triangles (…, 1, 3, 3), by volumes."""

    def volume(p, q, r, s):
        return np.linalg.det(np.stack(np.broadcast_arrays(q - p, r - p, s - p), axis=-2))

    a, b, c = np.moveaxis(triangle, -2, 0)
    apart = volume(a, b, c, start) * volume(a, b, c, end) < 0
    turns = np.stack([volume(start, end, *pair) > 0 for pair in ((a, b), (b, c), (c, a))])
    return apart & (turns.all(axis=0) | ~turns.any(axis=0))


@pytest.mark.parametrize("size", [4, 5])
def test_polygons_around_count_as_their_fans(size):
    points, faces, hole = with_square(0.5)
    count = len(points) - 4
    polygon = list(range(count, count + 4)) + ([len(points)] if size == 5 else [])
    points = np.concatenate([points, [[-3.5, 0, 0.5]]])[: len(points) + (size == 5)]
    mixed = [*faces[:-2].tolist(), polygon]
    filled = df.fill_holes(points, mixed, holes=[hole])
    assert filled.holes[0].crossings == 0
    assert filled.vertices[len(points) :, 2].max() < 0.5
