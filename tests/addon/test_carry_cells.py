# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of one refined face, against faces that are written down by hand."""

import numpy as np
import pytest
from test_lattice import TRIANGLE_ROWS, quad_cells, triangle_cells

from addon.carry.cells import make_cells

TRIANGLE_POINTS = [(i, j) for j, row in enumerate(TRIANGLE_ROWS) for i in range(len(row))]
QUAD_POINTS = [(i, j) for j in range(5) for i in range(5)]


@pytest.mark.parametrize(
    "corners, cells, points", [(3, triangle_cells(), TRIANGLE_POINTS), (4, quad_cells(), QUAD_POINTS)]
)
def test_points_and_cells(corners, cells, points):
    made = make_cells(corners, 2)
    assert [tuple(p) for p in made.points] == points
    assert np.array_equal(made.corner_point, cells.ravel())
    assert np.array_equal(made.corner_point[made.first_corner], np.arange(len(points)))


@pytest.mark.parametrize(
    "corners, places", [(3, [(0, 0), (4, 0), (0, 4)]), (4, [(0, 0), (4, 0), (4, 4), (0, 4)])]
)
def test_weights_give_the_points_back(corners, places):
    made = make_cells(corners, 2)
    assert np.array_equal(made.weights @ np.array(places) / made.total, made.points)
    assert (made.weights.sum(axis=1) == made.total).all()


@pytest.mark.parametrize("corners", [3, 4])
def test_no_level(corners):
    made = make_cells(corners, 0)
    assert np.array_equal(made.weights[made.corner_point], np.eye(corners))


def test_apex():
    assert tuple(make_cells(3, 2).points[make_cells(3, 2).apex]) == (0, 4)
