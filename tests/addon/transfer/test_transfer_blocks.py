# SPDX-License-Identifier: GPL-3.0-or-later
"""Large meshes in blocks: what is local comes out as if they were one."""

import numpy as np
import pytest
from polygons import grid, polygons

from addon import measured
from addon.core import module
from addon.transfer.blocks import blocks

df = pytest.importorskip("discrete_fairing")


def sheet(count, noise=0.0):
    at = np.linspace(-1, 1, count + 1)
    x, y = (values.ravel() for values in np.meshgrid(at, at, indexing="ij"))
    z = 0.3 * np.cos(x) * np.cos(y) + noise * np.random.default_rng(0).standard_normal(len(x))
    return polygons(np.stack([x, y, z], axis=1), grid(count + 1, count + 1))


def test_every_chosen_face_is_the_own_of_one_block():
    arrays = sheet(20)
    chosen = np.arange(400) % 20 < 13
    counts, around = np.zeros(400, int), 0.25
    for part, own in blocks(arrays, chosen, 30, around):
        assert 0 < own.sum() <= 30
        counts[part.faces[own]] += 1
        assert np.array_equal(arrays.positions[part.vertices], part.arrays.positions)
        centres = part.arrays.positions[part.arrays.corners].reshape(-1, 4, 3).mean(axis=1)
        own_corners = part.vertices[part.arrays.corners.reshape(-1, 4)[own]]
        assert np.array_equal(own_corners, arrays.corners.reshape(-1, 4)[part.faces[own]])
        assert (np.ptp(centres, axis=0) <= np.ptp(centres[own], axis=0) + 2 * around + 1e-9).all()
        # all around it, too
        whole = arrays.positions[arrays.corners].reshape(-1, 4, 3).mean(axis=1)
        low, high = centres[own].min(axis=0) - around, centres[own].max(axis=0) + around
        assert ((whole >= low) & (whole <= high)).all(axis=1).sum() == len(part.faces)
    assert np.array_equal(counts, chosen.astype(int))


def test_nothing_chosen_is_no_block():
    assert list(blocks(sheet(3), np.zeros(9, bool), 4, 0.1)) == []


@pytest.mark.parametrize("weight", [0.1, 0.003])
def test_a_scan_in_blocks_is_smoothed_as_in_one(monkeypatch, weight):
    noise = 0.004
    arrays = sheet(60, noise)
    free = (np.abs(arrays.positions[:, :2]) < 0.99).all(axis=1)

    def arguments(part):
        return {"vertices": part.positions, "faces": (part.corners, part.offsets)}

    found = []
    for size in (4000, 450):
        monkeypatch.setattr(measured, "BLOCK", size)
        runs = module().watching.SeveralRuns(None, None, 1)
        found.append(measured.smoothed(arrays, arguments, free, weight, runs).vertices)
    moved = np.abs(found[0] - arrays.positions).max()
    assert moved > noise and np.array_equal(found[0][~free], arrays.positions[~free])
    assert np.abs(found[1] - found[0]).max() < 0.02 * noise
