# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a mesh with a symmetry plane, as an object: the half of what the whole becomes."""

import bpy
import numpy as np
import pytest
from scenes import activate, add


def half_bowl():
    """A quarter turn of rows from the plane x = 0, open above."""
    angles, heights = np.meshgrid(
        np.linspace(-np.pi / 2, np.pi / 2, 7), np.linspace(-1.2, 0.3, 4), indexing="ij"
    )
    points = np.stack(
        [
            np.cos(heights) * np.cos(angles),
            2 * np.cos(heights) * np.sin(angles),
            np.sin(heights),
        ],
        axis=-1,
    ).reshape(-1, 3)
    points[:4, 0] = points[-4:, 0] = 0.0
    faces = [
        (4 * i + j, 4 * i + 4 + j, 4 * i + 5 + j, 4 * i + 1 + j) for i in range(6) for j in range(3)
    ]
    return add("Bowl", points.tolist(), faces)


def positions(target):
    out = np.empty(3 * len(target.data.vertices), np.float32)
    target.data.vertices.foreach_get("co", out)
    return out.reshape(-1, 3)


def fair(source, **options):
    activate(source)
    assert bpy.ops.object.fairing_surface(**{"levels": 3, **options}) == {"FINISHED"}
    return bpy.context.object


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 1)])
def test_the_half_fits_the_whole(scale):
    source = half_bowl()
    source.scale = scale
    bpy.context.view_layer.update()
    half = fair(source, symmetry_plane="X")
    assert half.discrete_fairing.symmetry_plane == "X"
    source.hide_set(False)
    mirror = source.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis = (True, False, False)
    whole = fair(source, mesh_source="EVALUATED")
    there = positions(whole)
    kept = there[there[:, 0] > -1e-7]
    own = positions(half)
    assert len(own) == len(kept)
    apart = np.abs(own[:, None] - kept[None]).max(axis=2).min(axis=1)
    assert apart.max() < 1e-4
    assert (own[:, 0] == 0).sum() == 2 * (3 * 8 + 1), "the seam lies in the plane"


def test_live_and_recompute_keep_the_half():
    source = half_bowl()
    half = fair(source, symmetry_plane="X", levels=2)
    before = positions(half)
    activate(half)
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
    assert np.array_equal(positions(half), before)
    half.discrete_fairing_live.on = True
    source.data.vertices[9].co.z -= 0.2
    source.data.update()
    bpy.context.view_layer.update()
    assert len(half.data.vertices) == len(before)
    assert not np.array_equal(positions(half), before)
    half.discrete_fairing_live.on = False


def test_uv_and_groups_come_along():
    source = half_bowl()
    source.data.uv_layers.new(name="UV")
    group = source.vertex_groups.new(name="Keel")
    group.add([0, 1, 2, 3], 0.75, "REPLACE")
    half = fair(source, symmetry_plane="X", levels=2)
    assert half.data.uv_layers["UV"] and half.vertex_groups["Keel"]
    assert half.vertex_groups["Keel"].weight(0) == pytest.approx(0.75)


def test_without_a_border_in_the_plane_it_says_so():
    source = half_bowl()
    activate(source)
    with pytest.raises(RuntimeError, match="no border edge lies in the plane y = 0"):
        bpy.ops.object.fairing_surface(levels=1, symmetry_plane="Y")
