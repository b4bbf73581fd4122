# SPDX-License-Identifier: GPL-3.0-or-later
"""Needles, dots, labels and texts of strain, as plain arrays."""

import numpy as np
import pytest

from addon.strain import drawn
from addon.strain.strained import Strained

pytestmark = pytest.mark.plain

NAN = float("nan")


def strained(lengths=(0.01, -0.04, NAN, 0.02), edge=1.0):
    lengths = np.array(lengths)
    positions = np.arange(3.0 * len(lengths)).reshape(-1, 3)
    ways = np.zeros_like(positions)
    ways[:, 2] = np.nan_to_num(lengths)
    return Strained(positions, ways, lengths, 0.025, edge, np.array([1]))


@pytest.mark.parametrize(
    ("longest", "edge", "length", "times"),
    [
        (0.04, 1.0, 1.0, 20.0),
        (0.04, 1.0, 0.5, 10.0),
        (0.05, 1.0, 1.0, 20.0),
        (2.0, 1.0, 1.0, 1.0),
        (1e-9, 1.0, 1.0, 1000.0),
        (0.0, 1.0, 1.0, 1.0),
        (0.04, 1.0, 0.0, 1.0),
    ],
)
def test_needles_are_lengthened_by_round_numbers(longest, edge, length, times):
    assert drawn.magnification(strained((0.0, longest), edge), length) == times


def test_a_needle_goes_from_its_vertex_to_where_the_surface_wants_to_be():
    it = strained()
    points, colours = drawn.needles(it, 10.0)
    assert points.shape == (6, 3) and colours.shape == (6, 4) and points.dtype == np.float32
    assert np.array_equal(points[::2], np.float32(it.positions[[0, 1, 3]]))
    assert (points[1::2] - points[::2])[:, 2] == pytest.approx([0.1, -0.4, 0.2], abs=1e-6)
    red, blue = colours[4], colours[2]
    assert red[0] > red[2] and blue[2] > blue[0], "outside is red, inside blue"
    assert np.array_equal(colours[::2], colours[1::2])
    assert np.ptp(colours[0, :3]) < np.ptp(red[:3]), "small strains are pale"
