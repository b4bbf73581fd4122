# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark that measures STEP files: its distances are those by hand."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "benchmarks"))

step_distances = pytest.importorskip("step_distances")
RANDOM = np.random.default_rng(5)


def sheet(n):
    """n x n cells of the unit square, each two triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower = np.stack([corner, corner + n + 1, corner + n + 2], axis=1)
    upper = np.stack([corner, corner + n + 2, corner + 1], axis=1)
    return points, np.concatenate([lower, upper])


def test_over_a_sheet_it_is_the_height():
    points, triangles = sheet(6)
    above = RANDOM.random((200, 3)) * (1, 1, 0.1)
    found = step_distances.distances(above, points, triangles)
    np.testing.assert_allclose(found, above[:, 2], rtol=0, atol=1e-15)


def test_beside_it_the_way_to_its_border_and_corner():
    points, triangles = sheet(4)
    beside = np.array([[1.3, 0.41, 0.4], [1.3, 1.4, 0.0], [-0.2, 0.5, 0.0]])
    found = step_distances.distances(beside, points, triangles)
    np.testing.assert_allclose(found, [0.5, 0.5, 0.2], rtol=0, atol=1e-15)


def test_a_bulge_of_one_patch_is_seen():
    """Of a paraboloid over flat triangles: its own height above them."""
    points, triangles = sheet(4)
    above = np.array([[0.5, 0.5, 0.0]] * 50)
    above[17, 2] = 3e-3
    assert step_distances.distances(above, points, triangles).max() == 3e-3
