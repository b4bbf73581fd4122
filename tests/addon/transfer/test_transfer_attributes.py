# SPDX-License-Identifier: GPL-3.0-or-later
"""Values on refined elements: exact, linear, and never across faces; and values spread over a filling."""

from types import SimpleNamespace

import numpy as np
import pytest
from lattices import lattice_faces
from refined import control_arrays, core_run

from addon.transfer.attributes import AttributeTransfer
from addon.transfer.filling import spread

pytestmark = pytest.mark.plain

HEXAGON = [(np.cos(a), np.sin(a), 0) for a in np.arange(6) * np.pi / 3]
# a lopsided hexagon, a quad and a triangle in a plane; vertex 9 belongs to no face
POSITIONS = [
    *HEXAGON[:3],
    (-0.4, 0.3, 0),
    *HEXAGON[4:],
    (3, 0, 0),
    (3, 1, 0),
    (1.2, 1.5, 0),
    (9, 9, 9),
]
POLYGONS = [[0, 1, 2, 3, 4, 5], [0, 6, 7, 1], [1, 7, 8]]


def mixed(levels=2):
    arrays = control_arrays(POSITIONS, POLYGONS)
    result, transfer = core_run(arrays, levels)
    return arrays, result, transfer


def refined_corners(result):
    return np.concatenate([faces.ravel() for faces in result.faces])


def by_hand():
    """A transfer for one quad in 16 cells, whose control vertices have the ids of its corners, and those of others."""
    others = [i for i in range(25) if i not in (0, 4, 20, 24)]
    order = {old: new for new, old in enumerate([0, 4, 24, 20, *others])}
    cells = np.vectorize(order.get)(lattice_faces(5, 5)[:, [0, 3, 2, 1]]).astype(np.int32)
    result = SimpleNamespace(
        vertices=np.zeros((25, 3)),
        faces=(np.empty((0, 3), np.int32), cells),
        triangle_polygon=np.empty(0, np.int32),
        quad_polygon=np.zeros(16, np.int32),
        mended=None,
    )
    return AttributeTransfer(result, control_arrays(np.eye(4, 3), [[0, 1, 2, 3]]), 2), order


def test_quad_is_bilinear():
    transfer, order = by_hand()
    at = {order[5 * j + i]: (i / 4, j / 4, i * j / 16) for j in range(5) for i in range(5)}
    found = transfer.point(np.array([(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0)], np.float32))
    assert np.array_equal(found, [at[v] for v in range(25)])


def test_control_vertices_keep_their_values_with_or_without_faces():
    _, _, transfer = mixed(1)
    given = np.random.default_rng(1).normal(size=(len(POSITIONS), 3)).astype(np.float32)
    assert np.array_equal(transfer.point(given)[: len(given)], given)


def test_polygon_centre_is_its_centroid():
    arrays, _, transfer = mixed(0)
    centre = transfer.point(arrays.positions)[len(POSITIONS)]
    x, y, _ = arrays.positions[:6].T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    area = cross.sum() / 2
    centroid = [((v + np.roll(v, -1)) * cross).sum() / (6 * area) for v in (x, y)]
    assert np.allclose(centre, [*centroid, 0], atol=1e-6)
    assert transfer.pick_point(np.arange(10) + 5)[10] in range(5, 15), "one of its own"


def test_picked_points_are_the_nearest():
    transfer, order = by_hand()
    found = transfer.pick_point(np.array([10, 20, 30, 40]))
    at = {5 * j + i: found[order[5 * j + i]] for j in range(5) for i in range(5)}
    # ties go to the first corner of the face: 0 | 1 along the first side, 0 in the middle
    assert [at[i] for i in range(5)] == [10, 10, 10, 20, 20]
    assert [at[20 + i] for i in range(5)] == [40, 40, 30, 30, 30]
    assert at[12] == 10


def test_turned_faces():
    """The core may turn a face over: then its corners run the other way round than the polygon's."""
    arrays = control_arrays(
        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)], [[0, 1, 2, 3], [1, 2, 4]]
    )
    result, transfer = core_run(arrays, 1, repair="mend")
    assert result.report["flipped_faces"]
    found = transfer.corner(arrays.positions[arrays.corners])
    assert np.allclose(found, transfer.point(arrays.positions)[refined_corners(result)])


def fan(rim=12, rings=4):
    """A disk: the outermost ring first, its centre last."""
    angle = 2 * np.pi * np.arange(rim) / rim
    points = [
        np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle], 1)
        for r in np.arange(rings, 0, -1) / rings
    ]
    return np.concatenate([*points, np.zeros((1, 3))])


def test_a_constant_stays_to_the_bit():
    assert (spread(fan(), np.full((12, 2), 0.1)) == 0.1).all()


def test_values_are_between_those_of_the_rim_and_nearest_to_the_nearest():
    points = fan()
    known = np.random.default_rng(1).random((12, 3))
    found = spread(points, known)
    assert np.array_equal(found[:12], known)
    assert (found >= known.min(axis=0)).all() and (found <= known.max(axis=0)).all()
    assert np.allclose(found[-1], known.mean(axis=0)), "in the middle"
    close = points[:12] * 0.999
    assert np.allclose(spread(np.concatenate([points[:12], close]), known)[12:], known, atol=1e-3)
