# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator on real Blender meshes."""

import bpy
import numpy as np
import pytest
from scenes import (
    CUBE,
    activate,
    add,
    add_suzanne,
    edit,
    face_values,
    fair,
    positions,
    set_edge_attribute,
    snapshot,
)


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_cube_in_quads(source, levels):
    result = fair(levels=levels)
    assert result.name == "Box Fair" and result.data.name == "Box Fair"
    assert bpy.context.selected_objects == [result] and not source.select_get()
    assert result.data.validate(verbose=True) is False
    assert len(result.data.polygons) == 6 * 4**levels
    assert set(face_values(result.data, "loop_total", np.int32)) == {4}
    assert len(result.data.vertices) == 6 * 4**levels + 2
    assert np.array_equal(positions(result.data)[:8], positions(source.data))


def test_source_is_untouched_bit_by_bit():
    source = add_suzanne()
    source.location = (1, 2, 3)
    source.data.materials.append(bpy.data.materials.new("Clay"))
    bpy.context.view_layer.update()
    before = snapshot(source)
    fair(levels=1, use_crease_angle=True)
    assert snapshot(source) == before


def test_materials_and_shading_follow_the_faces(source):
    for name in ("Red", "Green", "Blue"):
        source.data.materials.append(bpy.data.materials.new(name))
    source.data.polygons.foreach_set("material_index", [0, 1, 2, 0, 1, 2])
    source.data.polygons.foreach_set("use_smooth", [True, False, True, False, True, False])
    result = fair(levels=2, shade_smooth=False)
    assert [m.name for m in result.data.materials] == ["Red", "Green", "Blue"]
    normals = np.array([p.normal for p in source.data.polygons])
    centres = np.array([p.center for p in result.data.polygons])
    owner = np.argmax(centres @ normals.T, axis=1)  # the side of the cube that each lies above
    assert np.array_equal(face_values(result.data, "material_index", np.int32), owner % 3)
    assert np.array_equal(face_values(result.data, "use_smooth", bool), owner % 2 == 0)


def test_smooth_by_default_and_sharp_where_the_source_is(source):
    source.data.polygons.foreach_set("use_smooth", [False] * 6)
    rim = [(1, 3), (3, 7), (5, 7), (1, 5)]
    set_edge_attribute(source.data, "sharp_edge", "BOOLEAN", rim, True)
    result = fair(levels=1)
    assert face_values(result.data, "use_smooth", bool).all()
    assert sum(edge.use_edge_sharp for edge in result.data.edges) == 2 * len(rim)
    corners = np.array([n.vector[:] for n in result.data.corner_normals])
    at = np.array([loop.vertex_index for loop in result.data.loops]) == 1
    assert len(np.unique(corners[at].round(4), axis=0)) > 1, "two sides of a sharp edge"


def test_materials_held_by_the_object(source):
    source.data.materials.append(bpy.data.materials.new("In Mesh"))
    source.material_slots[0].link = "OBJECT"
    source.material_slots[0].material = bpy.data.materials.new("In Object")
    result = fair(levels=1)
    slot = result.material_slots[0]
    assert slot.link == "OBJECT" and slot.material.name == "In Object"
    assert result.data.materials[0].name == "In Mesh"


def test_place_parent_and_collection():
    parent = bpy.data.objects.new("Parent", None)
    parts = bpy.data.collections.new("Parts")
    bpy.context.scene.collection.children.link(parts)
    parts.objects.link(parent)
    source = add("Box", *CUBE)
    parts.objects.link(source)
    bpy.context.collection.objects.unlink(source)
    source.parent = parent
    parent.location, source.location = (1, 0, 0), (0, 2, 0)
    source.rotation_euler, source.scale = (0.1, 0.2, 0.3), (1, 2, 3)
    activate(source)
    result = fair(levels=1)
    bpy.context.view_layer.update()
    assert result.parent == parent and list(result.users_collection) == [parts]
    assert result.matrix_world == source.matrix_world


def test_edit_mode_sees_the_latest_edit(source):
    edit(source, "VERT", range(8))
    bpy.ops.transform.resize(value=(2, 2, 2))
    result = fair(levels=1)
    assert np.array_equal(positions(result.data)[:8], 2 * np.float32(CUBE[0]))
    assert bpy.context.mode == "OBJECT" and source.mode == "OBJECT"
