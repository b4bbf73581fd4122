# SPDX-License-Identifier: GPL-3.0-or-later
"""Zebra in files of several scenes."""

import bpy
import pytest
from scenes import CUBE, add

from addon.mesh.modifiers import inspection_modifier


def stripes_of(target):
    """How many stripes the material has that `target` is shown in."""
    group = inspection_modifier(target).node_group
    material = group.nodes["Material"].inputs["Material"].default_value
    return material.node_tree.nodes["Stripes"].inputs[1].default_value / 2.0


def smooth_of(target):
    return not inspection_modifier(target).node_group.nodes["Smooth"].mute


@pytest.mark.parametrize("kind", ["NEW", "LINK_COPY"])
def test_scenes_do_not_fight_over_zebra(kind):
    first, one = bpy.context.scene, add("One", *CUBE)
    bpy.ops.object.fairing_inspect(mode="ZEBRA")
    first.discrete_fairing_inspection.stripes = 7
    bpy.ops.scene.new(type=kind)
    second = bpy.context.scene
    assert second != first
    other = add("Other", *CUBE)
    bpy.ops.object.fairing_inspect(mode="ZEBRA")
    second.discrete_fairing_inspection.stripes = 30
    second.discrete_fairing_inspection.smooth = False
    if kind == "NEW":
        assert (stripes_of(one), stripes_of(other)) == (7, 30)
        assert (smooth_of(one), smooth_of(other)) == (True, False)
    else:  # an object of both shows what was said last
        assert (stripes_of(one), stripes_of(other)) == (30, 30)
        first.discrete_fairing_inspection.stripes = 5
        assert (stripes_of(one), stripes_of(other)) == (5, 30)
        assert smooth_of(one) and not smooth_of(other)


def test_off_leaves_nothing_of_any_scene():
    one = add("One", *CUBE)
    bpy.ops.object.fairing_inspect(mode="ZEBRA")
    bpy.ops.scene.new(type="NEW")
    add("Other", *CUBE)
    bpy.ops.object.fairing_inspect(mode="ZEBRA")
    bpy.ops.object.fairing_inspect(mode="NONE")
    assert len(bpy.data.materials) == len(bpy.data.node_groups) == 1
    one.discrete_fairing_inspection.mode = "NONE"
    assert not bpy.data.materials and not bpy.data.node_groups
