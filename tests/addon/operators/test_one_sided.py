# SPDX-License-Identifier: GPL-3.0-or-later
"""Bending fairs a Möbius strip, and its data comes along."""

import numpy as np
import one_sided_meshes
import pytest
from scenes import add, faces_at_edges, fair, positions

AROUND = 8


def strip():
    points, faces = one_sided_meshes.strip(AROUND, 2)
    return add("Strip", points.tolist(), faces.tolist())


@pytest.mark.parametrize("repair", ["MEND", "REFUSE"])
def test_one_sheet_with_its_uv_map(repair):
    source = strip()
    uv = source.data.uv_layers.new(name="Strip").uv
    for polygon in source.data.polygons:  # u runs on to 1 in the face before the seam
        for k, corner in enumerate(polygon.loop_indices):
            around, across = divmod(polygon.index, 2)
            uv[corner].vector = ((around + (k in (1, 2))) / AROUND, (across + (k in (2, 3))) / 2)
    target = fair(levels=2, repair=repair)
    counts = faces_at_edges(target.data)
    assert set(counts) == {1, 2} and counts.count(1) == 4 * 2 * AROUND
    assert not target.data.validate()
    assert len(target.data.vertices) == 4 * AROUND * 9
    assert np.array_equal(positions(target.data)[: 3 * AROUND], positions(source.data))
    made = target.data.uv_layers["Strip"].uv
    for polygon in target.data.polygons:
        around, across = divmod(polygon.index // 16, 2)
        corners = np.array([made[k].vector for k in polygon.loop_indices])
        low, high = corners.min(0), corners.max(0)
        assert (low >= [around / AROUND - 1e-6, across / 2 - 1e-6]).all()
        assert (high <= [(around + 1) / AROUND + 1e-6, (across + 1) / 2 + 1e-6]).all()
        assert np.allclose(high - low, [1 / AROUND / 4, 1 / 8], atol=0.02)
