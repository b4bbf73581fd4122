# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface keeps its own data when it is computed anew."""

import bpy
import numpy as np
import pytest
from live_scenes import live, move, pull, session
from refined import values
from scenes import CUBE, add, fair, positions, recompute

from addon.live import handlers


def adorn(target):
    """Gives a surface data of each kind, none of them from its source."""
    mesh = target.data
    target.vertex_groups.new(name="Mine").add([0, 5, 20], 0.25, "REPLACE")
    target.modifiers.new("Dents", "DISPLACE").vertex_group = "Mine"
    height = mesh.attributes.new("height", "FLOAT", "POINT")
    height.data.foreach_set("value", positions(mesh)[:, 2])
    uv = mesh.uv_layers.new(name="Unwrapped")
    corners = np.array([positions(mesh)[loop.vertex_index][:2] for loop in mesh.loops])
    uv.uv.foreach_set("vector", np.float32(corners).ravel())
    colour = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    colour.data.foreach_set("color", np.ones(4 * len(mesh.vertices), np.float32))
    upper = mesh.attributes.new("upper", "BOOLEAN", "FACE")
    upper.data.foreach_set("value", [face.center.z > 0 for face in mesh.polygons])
    mesh.edges[3].use_seam = True
    mesh["note"] = "by hand"
    mesh.materials.append(bpy.data.materials.new("Paint"))
    return mesh


@pytest.mark.parametrize("again", [1, 2])
def test_it_stays_to_the_bit_on_the_same_faces(source, again):
    mesh = adorn(target := fair(levels=2))
    heights, uv = values(mesh, "height"), values(mesh, "Unwrapped", "vector", 2)
    for _ in range(again):
        move(source)
        recompute()
    mesh = target.data
    assert positions(mesh)[0][2] == np.float32(-1.0 + 0.5 * again)
    assert [round(target.vertex_groups["Mine"].weight(i), 3) for i in (0, 5, 20)] == [0.25] * 3
    assert target.modifiers["Dents"].vertex_group in target.vertex_groups
    assert np.array_equal(values(mesh, "height"), heights)
    assert np.array_equal(values(mesh, "Unwrapped", "vector", 2), uv)
    assert mesh.color_attributes["Paint"].data[7].color[:] == (1.0, 1.0, 1.0, 1.0)
    assert sum(item.value for item in mesh.attributes["upper"].data) > 0
    assert mesh.edges[3].use_seam and mesh["note"] == "by hand"
    assert [material.name for material in mesh.materials] == ["Paint"]


@pytest.mark.parametrize("levels", [1, 3])
def test_other_faces_take_it_over_from_the_nearest(levels, capfd):
    add("Box", *CUBE)
    mesh = adorn(target := fair(levels=2))
    target.discrete_fairing.levels = levels
    recompute()
    mesh = target.data
    assert len(mesh.polygons) == 6 * 4**levels
    # a surface of another level is a little off
    assert np.abs(values(mesh, "height") - positions(mesh)[:, 2]).max() < 0.15
    corners = np.array([positions(mesh)[loop.vertex_index][:2] for loop in mesh.loops])
    assert np.abs(values(mesh, "Unwrapped", "vector", 2) - corners).max() < 0.2
    wrong = [
        face.index
        for face, item in zip(mesh.polygons, mesh.attributes["upper"].data)
        if item.value != (face.center.z > 0) and abs(face.center.z) > 0.1
    ]
    assert not wrong
    assert target.vertex_groups["Mine"].weight(0) == pytest.approx(0.25, abs=0.01)
    said = capfd.readouterr().out
    assert "'height', " in said and "nearest" in said and "'seam' is" in said


def test_what_comes_from_the_source_is_renewed_or_goes(source):
    source.vertex_groups.new(name="Theirs").add([0, 1], 0.5, "REPLACE")
    source.data.attributes.new("old", "FLOAT", "POINT")
    target = fair(levels=1)
    target.vertex_groups["Theirs"].add([0], 1.0, "REPLACE")
    source.data.attributes.remove(source.data.attributes["old"])
    source.vertex_groups["Theirs"].add([0], 0.75, "REPLACE")
    recompute()
    assert target.vertex_groups["Theirs"].weight(0) == 0.75 and len(target.vertex_groups) == 1
    assert "old" not in target.data.attributes


def test_shape_keys_of_its_own_and_their_animation(source):
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Up").data[0].co.z += 0.5
    target = fair(levels=1)
    own = target.shape_key_add(name="Bump", from_mix=False)
    own.data[9].co.z += 0.25
    keys = target.data.shape_keys
    for frame, value in ((1, 0.0), (10, 1.0)):
        keys.key_blocks["Bump"].value = value
        keys.key_blocks["Bump"].keyframe_insert("value", frame=frame)
    driver = keys.key_blocks["Up"].driver_add("value").driver
    driver.expression = "0.5"
    action = keys.animation_data.action
    meshes = len(bpy.data.meshes)
    move(source)
    recompute()
    keys, basis = target.data.shape_keys, positions(target.data)
    assert [block.name for block in keys.key_blocks] == ["Basis", "Up", "Bump"]
    moved = keys.key_blocks["Bump"].data[9].co.z - basis[9][2]
    assert moved == pytest.approx(0.25, abs=1e-5)
    assert keys.animation_data.action == action and len(keys.animation_data.drivers) == 1
    bpy.context.scene.frame_set(10)
    assert keys.key_blocks["Bump"].value == pytest.approx(1.0)
    assert len(bpy.data.meshes) == meshes


def test_live_and_its_full_level_keep_it(source):
    mesh = adorn(target := fair(levels=3))
    heights = values(mesh, "height")
    target.discrete_fairing_live.levels = 1
    live(target)
    pull(source)
    assert len(target.data.polygons) == 6 * 4 and "Mine" in target.vertex_groups
    assert target.data["note"] == "by hand"
    bpy.ops.object.fairing_live()
    assert len(target.data.polygons) == 6 * 4**3
    assert np.array_equal(values(target.data, "height"), heights), "not by way of the live level"


def animated_key(target):
    """A shape key of its own, with a keyframe."""
    target.shape_key_add(name="Basis")
    key = target.shape_key_add(name="Bump", from_mix=False)
    key.data[9].co.z += 0.25
    key.keyframe_insert("value", frame=1)


def names_of_keys(target):
    keys = target.data.shape_keys
    return [block.name for block in keys.key_blocks] if keys is not None else []


def drag():
    """A live surface in the middle of an edit, with an animated key of its own."""
    source = add("Box", *CUBE)
    target = fair(levels=2)
    animated_key(target)
    target.discrete_fairing_live.levels = 1
    meshes = len(bpy.data.meshes)
    live(target)
    pull(source)
    assert not names_of_keys(target), "handlers write none"
    return source, target, meshes


def test_live_that_ends_in_mid_edit_gives_keys_back_and_leaves_no_mesh():
    source, target, meshes = drag()
    bpy.data.objects.remove(source)
    handlers.on_timer()
    assert session(target) is None and len(bpy.data.meshes) == meshes
    assert names_of_keys(target) == ["Basis", "Bump"]
    assert target.data.shape_keys.animation_data.action is not None


def test_a_file_saved_in_mid_edit_has_the_keys(tmp_path):
    source, target, meshes = drag()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "mid.blend"), copy=True)
    assert names_of_keys(target) == ["Basis", "Bump"]
    pull(source)
    assert not names_of_keys(target)
    bpy.ops.object.fairing_live()
    key = target.data.shape_keys.key_blocks["Bump"]
    moved = np.linalg.norm([k.co - v.co for k, v in zip(key.data, target.data.vertices)], axis=1)
    # as on the full level
    assert moved[9] == pytest.approx(0.25, abs=1e-5) and (moved > 1e-5).sum() == 1
    assert len(bpy.data.meshes) == meshes
    with bpy.data.libraries.load(str(tmp_path / "mid.blend")) as (there, wanted):
        wanted.meshes = [name for name in there.meshes if name == "Box Fair"]
    assert "Bump" in wanted.meshes[0].shape_keys.key_blocks
