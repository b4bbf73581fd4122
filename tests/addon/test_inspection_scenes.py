# SPDX-License-Identifier: GPL-3.0-or-later
"""Zebra in files of several scenes."""

from types import SimpleNamespace

import bpy
import pytest
from scenes import CUBE, add

from addon.inspection import viewport_shading
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


class Space:
    """A viewport: without a window there is none."""

    def __init__(self, shading="SOLID", colour="MATERIAL"):
        self.type = "VIEW_3D"
        self.shading = SimpleNamespace(type=shading, color_type=colour)

    def as_pointer(self):
        return id(self)

    @property
    def now(self):
        return self.shading.type, self.shading.color_type


@pytest.mark.parametrize("before", [("SOLID", "MATERIAL"), ("WIREFRAME", "OBJECT")])
def test_a_click_is_seen_and_off_leads_back(before):
    space = Space(*before)
    viewport_shading.show(space, "ZEBRA")
    assert space.now[0] == "MATERIAL" and viewport_shading.shows(space, "ZEBRA")
    viewport_shading.show(space, "MEAN")
    assert viewport_shading.shows(space, "MEAN")
    viewport_shading.show(space, "NONE")
    assert space.now == before


def test_a_viewport_that_shows_it_is_left_alone():
    space = Space("RENDERED")
    viewport_shading.show(space, "ZEBRA")
    viewport_shading.show(space, "NONE")
    assert space.now == ("RENDERED", "MATERIAL")
    plain = Space("SOLID", "VERTEX")
    viewport_shading.show(plain, "GAUSS")
    assert plain.now == ("SOLID", "VERTEX")


def test_zebra_in_edit_mode():
    one = add("One", *CUBE)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.object.fairing_inspect(mode="ZEBRA") == {"FINISHED"}
    modifier = inspection_modifier(one)
    assert modifier.show_viewport and modifier.show_in_editmode
