# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals that the surface has at vertices of its border."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from discrete_fairing.joints.border_fits import border_of
from discrete_fairing.joints.borders import mesh_arrays
from test_neighbour import PAIRS, fair, quads, seam, triangles
from test_normals import LARGEST, SIDE, angle, none, tilted

EDGE = SIDE // 2  # the middle of the plate's border along x


@pytest.fixture(scope="module")
def plate():
    return meshes.grid(SIDE, SIDE)


def border(result):
    return border_of(*mesh_arrays((result.vertices, result.faces)))


def normal_at(result, vertex):
    """Of a polynomial fitted to five rings of faces."""
    found = border(result)
    return found.normal[found.slot[vertex]]


# degrees that the polynomial sees: 4.3, 1.3, 0.4; without the couple 45
@pytest.mark.parametrize("pad_size", [1.0, 0.0])
@pytest.mark.parametrize("levels,seen", [(3, 5), (4, 1.5), (5, 0.5)])
def test_a_plate_has_the_normal_at_its_border(plate, levels, seen, pad_size):
    points, faces = plate
    free = df.fair(points, faces, levels, pad_size=pad_size)
    result = df.fair(
        points, faces, levels, pad_size=pad_size, normals=tilted(points, EDGE, [0, -3, 3])
    )
    assert angle(normal_at(result, EDGE), [0, -1, 1]) < seen
    assert result.report["normals"]["fixed"] == 1
    assert result.report["normals"]["largest_angle"] <= LARGEST
    assert result.report["converged"] and not result.report["warnings"]
    moved = np.abs(result.vertices - free.vertices).max(1)
    assert not moved[border(free).vertex].any() and 0.09 < moved.max() < 0.13


@pytest.mark.parametrize("make", [quads, triangles])
@pytest.mark.parametrize("pair", PAIRS)
def test_vertices_of_a_border_have_the_normals_of_a_neighbour(pair, make):
    """The border curve stays, bit for bit; kinks were 7 to 23 degrees, a fit sees 0.2 to 1.1."""
    fixed, other = map(make, PAIRS[pair]())
    first, free = fair(fixed, 4), fair(other, 4)
    before = seam(free, first)
    chosen = before.vertex < len(other[0])
    vertices, kinks = before.vertex[chosen], np.degrees(before.kink[chosen])
    normals, own = none(other[0]), border(free)
    goal = border(first).at(other[0][vertices]).normal
    along = np.sum(goal * own.normal[own.slot[vertices]], axis=1, keepdims=True)
    normals[vertices] = goal * np.sign(along)
    met = fair(other, 4, normals=normals)
    after = np.degrees(seam(met, first).kink[chosen])
    assert met.report["normals"]["fixed"] == len(vertices) and met.report["converged"]
    assert met.report["normals"]["largest_angle"] <= LARGEST
    assert kinks.max() > 6 and after.max() < 1.2 and after.max() < kinks.max() / 20
    assert np.array_equal(met.vertices[own.vertex], free.vertices[own.vertex])


def test_a_normal_that_leans_along_the_border_is_named_with_its_angle(plate):
    points, faces = plate
    leaning = df.fair(points, faces, 3, normals=tilted(points, EDGE, [0.2, 0.5, 1]))
    upright = df.fair(points, faces, 3, normals=tilted(points, EDGE, [0, 0.5, 1]))
    (warning,) = leaning.report["warnings"]
    assert (warning["code"], warning["elements"]) == ("NORMAL_NOT_FIXED", [EDGE])
    assert "10 degrees" in warning["message"]
    assert leaning.vertices == pytest.approx(upright.vertices, abs=1e-9)
    with pytest.raises(df.FairingError, match="80 degrees"):
        df.fair(points, faces, 3, normals=tilted(points, EDGE, [1, 0, 0.1]))


def test_corners_and_ends_are_left_to_their_curves(plate):
    """There two curves have tangents of their own. A vertex of one face has no spoke to turn."""
    points, faces = plate
    normals = tilted(points, [0, SIDE, EDGE], [0, 0.3, 1])
    crease = [[EDGE, EDGE + SIDE + 1]]
    for options, left in (
        ({}, [0, SIDE]),
        ({"crease_edges": crease}, [0, EDGE, SIDE]),
        ({"corner_vertices": [EDGE]}, [0, EDGE, SIDE]),
    ):
        result = df.fair(points, faces, 2, normals=normals, **options)
        (warning,) = result.report["warnings"]
        assert warning["code"] == "NORMAL_NOT_FIXED" and warning["elements"] == left
        assert result.report["normals"]["fixed"] == 3 - len(left)


def test_a_rim_without_ends_opens_like_a_trumpet():
    turn, height = np.meshgrid(np.arange(8) * np.pi / 4, np.arange(4.0), indexing="ij")
    points = np.stack([np.cos(turn), np.sin(turn), height], axis=-1).reshape(-1, 3)
    at = np.arange(32).reshape(8, 4)
    on = np.roll(at, -1, axis=0)
    faces = np.stack([at[:, :-1], on[:, :-1], on[:, 1:], at[:, 1:]], axis=-1).reshape(-1, 4)
    rim = at[:, -1]
    normals = none(points)
    normals[rim] = points[rim] * [1, 1, 0] - [0, 0, 1]
    result = df.fair(points, faces, 4, normals=normals)
    assert result.report["normals"]["fixed"] == 8 and result.report["converged"]
    assert result.report["normals"]["largest_angle"] <= LARGEST and not result.report["warnings"]
    for vertex in rim:
        assert angle(normal_at(result, vertex), normals[vertex]) < 2
