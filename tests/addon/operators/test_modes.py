# SPDX-License-Identifier: GPL-3.0-or-later
"""What is faired: several objects, Edit Mode, modifiers; and what becomes of the source."""

import bpy
import numpy as np
import pytest
from scenes import CUBE, activate, add, fair, positions

from addon.mesh.object import select_only


def test_source_is_hidden_and_shown_again_on_demand():
    source = add("Box", *CUBE)
    fair(levels=1)
    assert source.hide_get() and not source.hide_viewport
    source.hide_set(False)
    activate(source)
    fair(levels=1, hide_source=False)
    assert not source.hide_get()


def with_mirror():
    """Half a box whose other half is a modifier's."""
    source = add("Half", *CUBE)
    for vertex in source.data.vertices:
        vertex.co.x += 1.0
    source.data.polygons.foreach_set("select", [False] * 6)
    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.subdivision_type = 1, "SIMPLE"
    return source


def test_mesh_with_its_modifiers():
    source = with_mirror()
    assert len(fair(levels=1, mesh_source="EVALUATED").data.polygons) == 4 * 6 * 4
    activate_shown(source)
    assert len(fair(levels=1).data.polygons) == 6 * 4
    assert len(source.data.polygons) == 6, "the source is only read"


def activate_shown(source):
    source.hide_set(False)
    activate(source)


def test_hidden_source_is_evaluated_all_the_same():
    source = with_mirror()
    result = fair(levels=1, mesh_source="EVALUATED")
    assert source.hide_get()
    source.modifiers["Subdivision"].levels = 2
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}
    assert len(result.data.polygons) == 16 * 6 * 4
    assert source.hide_get(), "as it was"


def test_modifiers_in_edit_mode():
    with_mirror()
    bpy.ops.object.mode_set(mode="EDIT")
    assert len(fair(levels=1, mesh_source="EVALUATED").data.polygons) == 4 * 6 * 4
    assert bpy.context.mode == "OBJECT"


def test_several_objects_in_edit_mode():
    sources = [add("Box", *CUBE), add("Crate", *CUBE)]
    select_only(bpy.context, sources)
    bpy.ops.object.mode_set(mode="EDIT")
    fair(levels=1)
    assert {o.name for o in bpy.context.selected_objects} == {"Box Fair", "Crate Fair"}


def test_one_bad_mesh_leaves_the_scene_as_it_was():
    good = add("Box", *CUBE)
    bad = add("Bad", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    good.select_set(True)
    before = set(bpy.data.objects), set(bpy.data.meshes)
    with pytest.raises(RuntimeError, match="Bad"):
        bpy.ops.object.fairing_surface(levels=1)
    assert (set(bpy.data.objects), set(bpy.data.meshes)) == before
    assert not good.hide_get() and bad.select_get() and good.select_get()


def grid(size=6):
    """A flat grid of quads with a pyramid's top in the midst."""
    points = [(x, y, 1.0 * (x == y == size // 2)) for y in range(size + 1) for x in range(size + 1)]
    row = size + 1
    faces = [
        (i + row * j, i + 1 + row * j, i + 1 + row * (j + 1), i + row * (j + 1))
        for j in range(size)
        for i in range(size)
    ]
    return add("Grid", points, faces)


def select_faces(source, chosen):
    source.data.polygons.foreach_set("select", [bool(chosen(p)) for p in source.data.polygons])
    source.data.update()


def test_only_the_selected_faces_are_faired():
    source = grid()
    select_faces(source, lambda p: all(1 <= c <= 5 for c in p.center[:2]))
    result = fair(levels=2, use_selection=True)
    points = positions(result.data)
    outside = (points[:, :2] <= 1).any(axis=1) | (points[:, :2] >= 5).any(axis=1)
    assert np.all(points[outside, 2] == 0.0)
    assert np.abs(points[~outside, 2]).max() > 0.5
    assert len(result.data.polygons) == 36 * 16


def test_edit_mode_selection_of_this_moment():
    source = grid()
    select_faces(source, lambda p: False)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    everything = positions(fair(levels=1, use_selection=True).data)
    activate_shown(source)
    assert np.array_equal(everything, positions(fair(levels=1).data))


def test_no_selected_face_is_an_error():
    source = grid()
    select_faces(source, lambda p: False)
    with pytest.raises(RuntimeError, match="No face is selected"):
        bpy.ops.object.fairing_surface(levels=1, use_selection=True)
