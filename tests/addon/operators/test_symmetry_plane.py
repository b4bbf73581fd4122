# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a mesh with a symmetry plane, as an object: the half of the whole mesh's surface."""

import bpy
import numpy as np
import pytest
from lattices import lattice_faces
from live_scenes import pull
from scenes import add, add_sheet, again, faces_at_edges, positions, recompute


def half_bowl():
    """A quarter turn of rows from the plane x = 0, open above."""
    angles, heights = np.meshgrid(
        np.linspace(-np.pi / 2, np.pi / 2, 7), np.linspace(-1.2, 0.3, 4), indexing="ij"
    )
    x, y = np.cos(heights) * np.cos(angles), 2 * np.cos(heights) * np.sin(angles)
    points = np.stack([x, y, np.sin(heights)], axis=-1).reshape(-1, 3)
    points[:4, 0] = points[-4:, 0] = 0.0
    return add("Bowl", points.tolist(), lattice_faces(7, 4).tolist())


def test_live_and_recompute_keep_the_half():
    source = half_bowl()
    source.data.uv_layers.new(name="UV")
    source.vertex_groups.new(name="Keel").add([0, 1, 2, 3], 0.75, "REPLACE")
    half = again(source, symmetry_plane="X", levels=2)
    assert half.data.uv_layers["UV"] and half.vertex_groups["Keel"].weight(0) == 0.75
    before = positions(half.data)
    recompute(half)
    assert np.array_equal(positions(half.data), before)
    half.discrete_fairing_live.on = True
    pull(source, 9, -0.2)
    assert len(half.data.vertices) == len(before)
    assert not np.array_equal(positions(half.data), before)
    half.discrete_fairing_live.on = False


def half_boat():
    """Half a hull: stem and keel in the plane y = 0, where the sides meet at an angle."""
    stations, levels = np.meshgrid(np.linspace(0, 6, 7), np.linspace(0, 1, 4), indexing="ij")
    breadth = np.sqrt(stations / 6) * (0.15 + 0.85 * levels)
    breadth[0] = breadth[:, 0] = 0.0
    points = np.stack([stations, breadth, levels + 0.02 * (6 - stations)], axis=-1)
    return add("Boat", points.reshape(-1, 3).tolist(), lattice_faces(7, 4).tolist())


def seam(target, axis):
    """The numbers of sharp edges and of all edges at the border in the plane of that axis."""
    mesh, faces = target.data, faces_at_edges(target.data)
    flat = np.abs(positions(mesh)[:, axis]) < 1e-6
    own = {e.index for e in mesh.edges if faces[e.index] == 1 and flat[list(e.vertices)].all()}
    sharp = {e.index for e in mesh.edges if e.use_edge_sharp}
    assert sharp <= own
    return len(sharp), len(own)


def test_stem_and_keel_of_half_a_hull_are_sharp():
    source = half_boat()
    half = again(source, levels=3)
    assert seam(half, 1) == (72, 72)
    half.discrete_fairing_live.on = True
    source.data.vertices[9].co.y += 0.1
    source.data.update()
    bpy.context.view_layer.update()
    assert seam(half, 1) == (72, 72)
    half.discrete_fairing_live.on = False


@pytest.mark.parametrize("modifiers", [["MIRROR"], ["MIRROR", "SUBSURF"]], ids=len)
@pytest.mark.parametrize("purpose", ["HULL", "POINTS"])
def test_jobs_on_vertices_make_the_whole_hull_of_a_half_and_keep_its_keel(purpose, modifiers):
    source = half_boat()
    _ = [source.modifiers.new(kind, kind) for kind in modifiers]
    source.modifiers[0].use_axis = (False, True, False)
    assert bpy.ops.object.fairing_for(purpose=purpose) == {"FINISHED"}
    whole = bpy.context.object
    assert [m.type for m in whole.modifiers] == ["MIRROR"] and seam(whole, 1) == (72, 72)
    assert positions(whole.data)[:, 2].min() > -1e-3, "Flow Lines swelled below a keel made round"
    assert bpy.ops.object.fairing_close() == {"FINISHED"}
    assert positions(bpy.context.object.data)[:, 2].min() > -1e-3, "so did those of the closed hull"


def test_a_hull_whose_keel_is_round_in_part_is_told_what_to_crease(capfd):
    source = half_boat()
    source.modifiers.new("Mirror", "MIRROR").use_axis = (False, True, False)
    for vertex in source.data.vertices[16:]:
        vertex.co.z = 0.02 * (6 - vertex.co.x) + vertex.co.y**2
    assert bpy.ops.object.fairing_for(purpose="HULL") == {"FINISHED"}
    assert bpy.context.object.discrete_fairing.energy == "THIN_PLATE"
    assert "for Boat: crease stem and keel where they are sharp" in capfd.readouterr().out


def test_a_seam_that_was_faired_across_is_not_sharp_and_none_that_is_tangent():
    assert seam(again(half_bowl(), levels=3, symmetry_plane="X"), 0) == (0, 48)
    along, across = np.linspace(0, 1, 5), np.linspace(-1, 1, 5)
    dish = add_sheet("Dish", along, across, lambda x, y: 0.3 * (x**2 + y**2))
    assert seam(again(dish, levels=3), 0) == (0, 32)
