# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes among quads, closed by grids of quads where their rims allow that."""

import discrete_fairing as df
import numpy as np
import pytest
from lattices import lattice_faces
from ragged_holes import cut


def tube(n=72, m=47):
    """Points and quads of a cylinder's side, with the radius 1."""
    angle, height = np.meshgrid(
        np.linspace(0, 2 * np.pi, n, endpoint=False), np.linspace(-2, 2, m), indexing="ij"
    )
    points = np.stack([np.cos(angle), np.sin(angle), height], -1).reshape(-1, 3)
    return points, lattice_faces(n, m, (True, False))


def holed(chosen):
    """The tube without the quads that `chosen` takes by angle and height of their centres, and its hole."""
    points, quads = tube()
    centre = points[quads].mean(axis=1)
    gone = chosen(np.arctan2(centre[:, 1], centre[:, 0]), centre[:, 2])
    points, kept = cut(points, quads, gone)
    (hole,) = (h for h in df.find_holes(points, kept) if abs(points[h][:, 2]).max() < 1.9)
    return points, kept, hole, int(gone.sum())


def sizes(filled):
    corners, offsets = filled.faces
    assert offsets[-1] == len(corners)
    return np.diff(offsets)


@pytest.mark.parametrize("width, height", [(40, 0.5), (110, 0.5), (3, 0.5)])
def test_a_rectangle_gets_its_grid_back(width, height):
    points, quads, hole, gone = holed(lambda a, z: (abs(a) < np.radians(width)) & (abs(z) < height))
    for loop in (hole, hole[::-1], np.roll(hole, 5)):
        filled = df.fill_holes(points, quads, holes=[loop], quads=True)
        (report,) = filled.holes
        assert (report.why_triangles, report.folds, report.crossings) == ("", 0, 0)
        assert len(filled.new_faces) == gone == len(report.faces)
        assert (sizes(filled) == 4).all()
        assert np.array_equal(filled.vertices[: len(points)], points)
        assert not df.check(filled.vertices, filled.faces)
        assert len(df.find_holes(filled.vertices, filled.faces)) == 2  # the tube's ends
        assert abs(np.hypot(*filled.vertices[len(points) :, :2].T) - 1).max(initial=0.0) < 0.003


def test_a_single_missing_quad_comes_back():
    points, quads = tube()
    filled = df.fill_holes(points, np.delete(quads, 20, 0), holes=[quads[20]], quads=True)
    assert len(filled.vertices) == len(points)
    corners, _ = filled.faces
    last = corners[-4:].tolist()
    assert sorted(last) == sorted(quads[20].tolist()) and not df.check(points, filled.faces)


def test_grids_only_where_they_are_asked_for():
    points, quads, hole, _ = holed(lambda a, z: (abs(a) < 0.5) & (abs(z) < 0.5))
    filled = df.fill_holes(points, quads, holes=[hole])
    assert (sizes(filled)[filled.new_faces] == 3).all() and not filled.holes[0].why_triangles


@pytest.mark.parametrize(
    "chosen, why",
    [
        (lambda a, z: a**2 + z**2 < 0.5, "skew"),
        (lambda a, z: (abs(a) < 0.6) & (abs(z) < 0.5) & ((a < 0) | (z < 0)), "fold"),
    ],
)
def test_else_triangles_and_the_reason(chosen, why):
    points, quads, hole, _ = holed(chosen)
    filled = df.fill_holes(points, quads, holes=[hole], quads=True)
    plain = df.fill_holes(points, quads, holes=[hole])
    assert why in filled.holes[0].why_triangles
    assert filled.vertices.tobytes() == plain.vertices.tobytes()
    assert np.array_equal(filled.faces[0], plain.faces[0])


def test_an_odd_rim_and_triangles_around():
    points, quads, hole, _ = holed(lambda a, z: (abs(a) < 0.5) & (abs(z) < 0.5))
    faces = quads.tolist()
    beside = next(k for k, f in enumerate(faces) if {hole[3], hole[4]} <= set(f))
    a = faces[beside].index(hole[4])
    b, c, d, e = np.roll(faces[beside], -a).tolist()
    assert e == hole[3] or c == hole[3]
    odd = faces[:beside] + faces[beside + 1 :] + ([[b, c, d]] if e == hole[3] else [[b, d, e]])
    loop = next(h for h in df.find_holes(points, odd) if hole[0] in h)
    assert len(loop) == len(hole) + 1
    assert "odd" in df.fill_holes(points, odd, holes=[loop], quads=True).holes[0].why_triangles
    split = faces[:beside] + faces[beside + 1 :] + [[b, c, d], [b, d, e]]
    told = df.fill_holes(points, split, holes=[hole], quads=True).holes[0].why_triangles
    assert told == "not all faces around are quads"


def test_islands():
    points, quads = tube()
    angle, height = np.arctan2(*points[quads].mean(1)[:, 1::-1].T), points[quads].mean(1)[:, 2]
    gone = (abs(angle) < 0.6) & (abs(height) < 0.6) & ((abs(angle) > 0.2) | (abs(height) > 0.2))
    points, kept = cut(points, quads, gone)
    loops = [h for h in df.find_holes(points, kept) if abs(points[h][:, 2]).max() < 1.9]
    rim, island = sorted(loops, key=len, reverse=True)
    filled = df.fill_holes(points, kept, holes=[[rim, island]], quads=True)
    assert "islands" in filled.holes[0].why_triangles
    assert not df.check(filled.vertices, filled.faces)
