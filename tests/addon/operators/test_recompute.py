# SPDX-License-Identifier: GPL-3.0-or-later
"""A faired object remembers its source and settings, and is computed again in place."""

import bpy
import numpy as np
from fake_layout import draw
from live_scenes import move
from scenes import CUBE, add, again, fair, positions, recompute, refused, reopen

from addon.memory import recall
from addon.ui import main


def test_recompute_follows_the_source(source):
    result = fair(levels=2)
    before = positions(result.data)
    move(source)
    recompute()
    assert bpy.context.active_object == result
    after = positions(result.data)
    assert np.array_equal(after[:8], positions(source.data)) and not np.array_equal(after, before)
    assert np.array_equal(after, positions(again(source, levels=2).data)), "as if it were made anew"


def test_recompute_with_other_settings():
    add("Box", *CUBE)
    result = fair(levels=1)
    result.discrete_fairing.levels = 3
    recompute()
    assert len(result.data.polygons) == 6 * 4**3
    assert recall(result, "report")["levels"][-1]["level"] == 3


def test_what_was_put_on_it_stays():
    add("Box", *CUBE)
    result = fair(levels=1)
    paint = bpy.data.materials.new("Paint")
    result.data.materials.append(paint)
    result.modifiers.new("Thick", "SOLIDIFY").thickness = 0.125
    result.location = (1, 2, 3)
    name, meshes = result.data.name, len(bpy.data.meshes)
    recompute()
    assert list(result.data.materials) == [paint]
    assert result.modifiers["Thick"].thickness == 0.125 and tuple(result.location) == (1, 2, 3)
    assert result.data.name == name and len(bpy.data.meshes) == meshes


def test_linked_duplicates_follow(source):
    result = fair(levels=1)
    twin = result.copy()
    bpy.context.collection.objects.link(twin)
    move(source)
    recompute()
    assert twin.data == result.data


def test_a_failure_leaves_the_surface(source):
    result = fair(levels=1, repair="REFUSE")
    before = positions(result.data)
    source.data.vertices[0].co = source.data.vertices[1].co  # a face collapses
    refused("Box", bpy.ops.object.fairing_recompute)
    assert np.array_equal(positions(result.data), before)


def test_without_its_source_it_is_a_mesh_like_any_other(source):
    result = fair(levels=1)
    bpy.data.objects.remove(source)
    assert result.discrete_fairing.source is None
    assert not bpy.ops.object.fairing_recompute.poll()
    assert "object.fairing_surface" in draw(main.VIEW3D_PT_fairing)
    assert not bpy.ops.object.fairing_show_source.poll()


def test_survives_saving(tmp_path):
    add("Box", *CUBE)
    fair(levels=1, metric_exponent=0.25, boundary="FREE")
    reopen(tmp_path)
    result = bpy.data.objects["Box Fair"]
    memory = result.discrete_fairing
    assert memory.source == bpy.data.objects["Box"]
    assert (memory.levels, memory.boundary, memory.metric_exponent) == (1, "FREE", 0.25)
    move(bpy.data.objects["Box"])
    recompute(result)
    assert np.array_equal(positions(result.data)[:8], positions(bpy.data.objects["Box"].data))
