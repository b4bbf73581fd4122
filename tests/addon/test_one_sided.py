# SPDX-License-Identifier: GPL-3.0-or-later
"""One-sided surfaces: Bending fairs a Möbius strip, and what lies on it comes with it."""

import bmesh
import bpy
import numpy as np
import pytest
from live_scenes import follow, live, move
from scenes import activate, add, fair, positions

AROUND = 8


def strip():
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    centre = np.stack([np.cos(angle), np.sin(angle), 0 * angle], -1)
    out = np.cos(angle / 2)[:, None] * centre + np.sin(angle / 2)[:, None] * [0, 0, 1]
    points = np.stack([2 * centre - out, 2 * centre, 2 * centre + out], 1).reshape(-1, 3)
    id = np.arange(3 * AROUND).reshape(AROUND, 3)
    after = np.roll(id, -1, 0)
    after[-1] = after[-1, ::-1].copy()
    faces = np.stack([id[:, :-1], after[:, :-1], after[:, 1:], id[:, 1:]], -1).reshape(-1, 4)
    return add("Strip", points.tolist(), faces.tolist())


def edge_counts(mesh):
    bm = bmesh.new()
    bm.from_mesh(mesh)
    counts = [len(edge.link_faces) for edge in bm.edges]
    bm.free()
    return counts


@pytest.mark.parametrize("repair", ["MEND", "REFUSE"])
def test_one_sheet_with_its_uv_map(repair):
    source = strip()
    uv = source.data.uv_layers.new(name="Strip").uv
    for polygon in source.data.polygons:  # u runs on to 1 in the face before the seam
        for k, corner in enumerate(polygon.loop_indices):
            around, across = divmod(polygon.index, 2)
            uv[corner].vector = (
                (around + (k in (1, 2))) / AROUND,
                (across + (k in (2, 3))) / 2,
            )
    target = fair(levels=2, repair=repair)
    counts = edge_counts(target.data)
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


def test_live_and_shape_keys_follow():
    source = strip()
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Bent").data[4].co.z += 0.5
    target = fair(levels=2)
    bent = target.data.shape_keys.key_blocks["Bent"]
    assert np.isclose(bent.data[4].co.z, source.data.shape_keys.key_blocks["Bent"].data[4].co.z)
    source.shape_key_clear()
    activate(target)
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
    live(target)
    move(source, 1, 0.1)
    follow()
    assert np.array_equal(positions(target.data)[: 3 * AROUND], positions(source.data))


def test_other_energies_say_what_to_do():
    strip()
    with pytest.raises(
        RuntimeError, match="Set Fairness to Bending, or cut it open.*only one side"
    ):
        bpy.ops.object.fairing_surface(levels=2, energy="TOTAL_CURVATURE")
