# SPDX-License-Identifier: GPL-3.0-or-later
"""Values spread over a filling: constants stay, and each value is a mean within those of the rim."""

import numpy as np
import pytest

from addon.transfer.filling import spread

pytestmark = pytest.mark.plain


def fan(rim=12, rings=4):
    """A disk: the outermost ring first, its centre last."""
    angle = 2 * np.pi * np.arange(rim) / rim
    points = [
        np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle], 1)
        for r in np.arange(rings, 0, -1) / rings
    ]
    i, j = np.arange(rim), (np.arange(rim) + 1) % rim
    faces = [
        np.concatenate([np.stack([i, j, j + rim], 1), np.stack([i, j + rim, i + rim], 1)]) + k * rim
        for k in range(rings - 1)
    ]
    last = (rings - 1) * rim
    faces.append(np.stack([i + last, j + last, 0 * i + rings * rim], 1))
    return np.concatenate([*points, np.zeros((1, 3))]), np.concatenate(faces)


def test_a_constant_stays_to_the_bit():
    points, faces = fan()
    assert (spread(points, faces, np.full((12, 2), 0.1)) == 0.1).all()


def test_each_value_is_the_weighted_mean_of_its_neighbours():
    points, faces = fan()
    known = np.random.default_rng(1).random((12, 3))
    found = spread(points, faces, known)
    assert np.array_equal(found[:12], known)
    assert (found >= known.min(axis=0)).all() and (found <= known.max(axis=0)).all()
    for v in range(12, len(points)):
        beside = np.unique(faces[(faces == v).any(axis=1)])
        beside = beside[beside != v]
        # diagonals of the lattice go one way: those that are edges share a triangle with v
        weight = 1 / np.linalg.norm(points[beside] - points[v], axis=1)
        mean = (weight[:, None] * found[beside]).sum(axis=0) / weight.sum()
        assert np.abs(mean - found[v]).max() < 1e-6
