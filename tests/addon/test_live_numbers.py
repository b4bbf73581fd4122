# SPDX-License-Identifier: GPL-3.0-or-later
"""What decides on solver and level: plain values."""

import numpy as np
import pytest

from addon.live import pace
from addon.live.inputs import fixed, same
from addon.live.pace import Pace


def test_vertices_are_not_fixed():
    assert fixed({"vertices": 1, "levels": 2}) == {"levels": 2}


@pytest.mark.parametrize("value", [None, 1, 0.5, "x", np.arange(3), (np.arange(3), np.arange(2)), {"a": 1}])
def test_same(value):
    assert same({"k": value}, {"k": value})


@pytest.mark.parametrize(
    "a, b",
    [
        (None, np.arange(3)),
        (np.arange(3), np.arange(4)),
        (np.arange(3), np.zeros(3, int)),
        ((np.arange(3), 1), (np.arange(3), 2)),
        ((1,), (1, 1)),
        ({"a": 1}, {"b": 1}),
        (1, True),
        (0.5, 0.25),
    ],
)
def test_not_same(a, b):
    assert not same({"k": a}, {"k": b})


def test_a_large_result_is_lowered_from_the_start():
    assert Pace().level(3, 1000) == 3
    assert Pace().level(5, pace.MOST // 4**3) == 3
    assert Pace().level(5, pace.MOST) == 1


def test_a_slow_update_lowers_the_level_for_good():
    it = Pace()
    it.note(3, 0.9 * pace.SLOW)
    assert it.level(3, 10) == 3
    it.note(3, 1.1 * pace.SLOW)
    assert it.level(3, 10) == 2
    it.note(2, 1.1 * pace.SLOW)
    it.note(1, 1.1 * pace.SLOW)
    assert it.level(3, 10) == 1
