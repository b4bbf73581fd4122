# SPDX-License-Identifier: GPL-3.0-or-later
"""The pace of Live chooses level and energy from plain values."""

import pytest

from addon.live import pace
from addon.live.pace import Pace

pytestmark = pytest.mark.plain


def slow(it, level, energy):
    for _ in range(pace.IN_A_ROW):
        it.note(level, energy, 1.1 * pace.SLOW)


def test_a_slow_one_now_and_then_does_not():
    it = Pace()
    for _ in range(5):
        it.note(3, "thin_plate", 1.1 * pace.SLOW)
        it.note(3, "thin_plate", 0.9 * pace.SLOW)
    assert it.level(3, 10) == 3


def test_the_fastest_energy_stands_in_where_levels_do_not_help():
    it = Pace()
    slow(it, 2, "total_curvature")
    assert (it.level(2, 10), it.energy("total_curvature")) == (1, "total_curvature")
    slow(it, 1, "total_curvature")
    assert (it.level(2, 10), it.energy("total_curvature")) == (2, "thin_plate")


def test_a_solve_beyond_the_limit():
    it = Pace()
    assert it.slow_down(3, "total_curvature", hopeless=True)
    assert (it.level(3, 10), it.energy("total_curvature")) == (3, "thin_plate")
    assert it.slow_down(3, "thin_plate", hopeless=True) and it.level(3, 10) == 2
    assert it.slow_down(2, "thin_plate", hopeless=True)
    assert not it.slow_down(1, "thin_plate", hopeless=True), "nothing is less"
