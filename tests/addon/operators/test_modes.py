# SPDX-License-Identifier: GPL-3.0-or-later
"""Several objects, Edit Mode and selections; and the source afterwards."""

import bpy
import numpy as np
from lattices import lattice_faces
from scenes import CUBE, add, again, edit, fair, positions, refused


def test_source_is_hidden_and_shown_again_on_demand(source):
    fair(levels=1)
    assert source.hide_get() and not source.hide_viewport
    again(source, levels=1, hide_source=False)
    assert not source.hide_get()


def test_one_bad_mesh_leaves_the_scene_as_it_was():
    good = add("Box", *CUBE)
    bad = add("Bad", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    good.select_set(True)
    before = set(bpy.data.objects), set(bpy.data.meshes)
    refused("Bad", bpy.ops.object.fairing_surface, levels=1)
    assert (set(bpy.data.objects), set(bpy.data.meshes)) == before
    assert not good.hide_get() and bad.select_get() and good.select_get()


def pyramid(size=6):
    """A flat grid of quads with a pyramid's top in the midst, no face selected."""
    points = [(x, y, 1.0 * (x == y == size // 2)) for x in range(size + 1) for y in range(size + 1)]
    source = add("Grid", points, lattice_faces(size + 1, size + 1).tolist())
    source.data.polygons.foreach_set("select", [False] * size**2)
    return source


def test_only_the_selected_faces_are_faired():
    source = pyramid()
    for face in source.data.polygons:
        face.select = all(1 <= c <= 5 for c in face.center[:2])
    result = fair(levels=2, use_selection=True)
    points = positions(result.data)
    outside = (points[:, :2] <= 1).any(axis=1) | (points[:, :2] >= 5).any(axis=1)
    assert np.all(points[outside, 2] == 0.0)
    assert np.abs(points[~outside, 2]).max() > 0.5
    assert len(result.data.polygons) == 36 * 16


def test_edit_mode_selection_of_this_moment():
    source = pyramid()
    refused("No face is selected", bpy.ops.object.fairing_surface, levels=1, use_selection=True)
    edit(source, "FACE", range(36))
    everything = positions(fair(levels=1, use_selection=True).data)
    assert np.array_equal(everything, positions(again(source, levels=1).data))
