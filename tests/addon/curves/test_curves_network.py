# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves, their meetings, and the cells that they enclose. No Blender."""

from dataclasses import replace

import networks
import numpy as np
import pytest

from addon.curves.cells import find_cells
from addon.curves.cubics import Curve, points_at, through
from addon.curves.network import network
from addon.curves.settle import remarks

pytestmark = pytest.mark.plain


def sizes(found):
    return sorted(len(cell.sides) for cell in found)


def even(curve, count=200):
    return points_at(curve.pieces, np.linspace(0, curve.end, count))


def test_a_spline_passes_its_points_and_bends_like_a_circle():
    [circle] = networks.great_circles()[:1]
    assert np.abs(np.linalg.norm(even(circle), axis=1) - 1).max() < 1e-4
    assert np.allclose(points_at(circle.pieces, np.arange(24.0))[6], (0, 1, 0))


def test_a_polygon_keeps_its_corners():
    square = through(np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float), True)
    points = even(Curve("Square", square, True))
    assert np.abs(np.abs(points[:, :2] - 0.5).max(axis=1) - 0.5).max() < 1e-12
    assert len(network([Curve("Square", square, True)]).arcs) == 4


@pytest.mark.parametrize(
    "make, inner, outer",
    [
        (networks.three_by_four, [4] * 6, 1),
        (networks.bonnet, [4] * 6, 1),
        (networks.hull, [4] * 4, 1),
        (networks.great_circles, [3] * 8, 0),
        (networks.tube, [4] * 8, 2),
        (networks.loop, [1], 1),
    ],
)
def test_cells(make, inner, outer):
    found = find_cells(network(make()))
    assert sizes(found.cells) == inner and len(found.open) == outer
    assert remarks(found.network) == []


def test_open_ends_are_filled_on_request():
    assert sizes(find_cells(network(networks.tube()), closed=True).cells) == [1, 1] + [4] * 8


def test_the_cells_do_not_depend_on_how_curves_run_and_stand():
    curves = networks.hull()
    turned = [replace(c, pieces=c.pieces[::-1, ::-1]) for c in curves[::-1]]
    spin = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    moved = [replace(c, pieces=5 * c.pieces @ spin + (7, 8, 9)) for c in turned]
    assert sizes(find_cells(network(moved)).cells) == [4] * 4


def test_what_ends_on_another_curve_is_a_side_of_it():
    short = networks.along("Short", 0.4, -1.0, -0.35)
    found = find_cells(network([*networks.three_by_four(), short]))
    assert sizes(found.cells) == [4] * 7 and remarks(found.network) == []


def test_a_short_tail_is_snapped():
    long = networks.along("Long", 0.4, -1.005, -0.345)
    found = find_cells(network([*networks.three_by_four(), long], 0.01))
    assert sizes(found.cells) == [4] * 7 and remarks(found.network) == []


def test_a_near_miss_is_named_with_its_cure():
    high = networks.across("High", 0.4)
    high = replace(high, pieces=high.pieces + (0, 0, 0.03))
    others = [c for c in networks.three_by_four() if c.name != "Column 2"]
    found = find_cells(network([*others, high], 0.01))
    assert sizes(found.cells) == [4] * 4
    said = remarks(found.network)
    assert sum("misses" in s and "raise Snap to 0.03" in s for s in said) == 3
    assert any(s.startswith("'Row 1' misses 'High' by 0.02981 near (0.39") for s in said)
    assert any(s.startswith("'High' encloses nothing") for s in said)
    assert sizes(find_cells(network([*others, high], 0.032)).cells) == [4] * 6


def test_a_bridge_between_two_parts_is_named():
    left = networks.polygon(4)
    right = [replace(c, name=f"Right {c.name}", pieces=c.pieces + (4, 0, 0)) for c in left]
    bridge = networks.drawn("Bridge", lambda t: (t, 0.0, 0.15), 1.0, 3.0, 3)
    found = find_cells(network([*left, *right, bridge]))
    assert sizes(found.cells) == [4, 4]
    assert any("'Bridge' encloses nothing" in s for s in remarks(found.network))
