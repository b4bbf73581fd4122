# SPDX-License-Identifier: GPL-3.0-or-later
"""Large meshes in pieces give what they give as a whole."""

import numpy as np
import pytest
from lattices import lattice_faces
from polygons import polygons

from addon.core import module
from addon.jobs import noise

pytestmark = pytest.mark.plain

df = pytest.importorskip("discrete_fairing")


def sheet(count, off=0.0):
    at = np.linspace(-1, 1, count + 1)
    x, y = (values.ravel() for values in np.meshgrid(at, at, indexing="ij"))
    z = 0.3 * np.cos(x) * np.cos(y) + off * np.random.default_rng(0).standard_normal(len(x))
    return polygons(np.stack([x, y, z], axis=1), lattice_faces(count + 1, count + 1))


@pytest.mark.parametrize("weight", [0.1, 0.003])
def test_a_scan_in_pieces_is_smoothed_as_in_one(monkeypatch, weight):
    off = 0.004
    arrays = sheet(60, off)
    free = (np.abs(arrays.positions[:, :2]) < 0.99).all(axis=1)

    given = {"vertices": arrays.positions, "faces": (arrays.corners, arrays.offsets)}
    found = []
    for size in (4000, 450):
        monkeypatch.setattr(noise, "PIECE", size)
        runs = module().watching.SeveralRuns(None, None, 1)
        found.append(noise.smoothed(given, free, weight, runs).vertices)
    moved = np.abs(found[0] - arrays.positions).max()
    assert moved > off and np.array_equal(found[0][~free], arrays.positions[~free])
    assert np.abs(found[1] - found[0]).max() < 0.02 * off
