# SPDX-License-Identifier: GPL-3.0-or-later
"""Zebra in files of several scenes."""

import bpy
import pytest
from scenes import CUBE, add

from addon.inspection import viewport_shading
from addon.mesh.modifiers import inspection_modifier


def stripes_of(target):
    """The number of stripes of the material that shows `target`."""
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


def viewports():
    areas = [area for screen in bpy.data.screens for area in screen.areas]
    return [area.spaces.active for area in areas if area.type == "VIEW_3D"]


def viewport(shading="SOLID", colour="MATERIAL"):
    """The viewport of a screen, which is not drawn without a window."""
    space = viewports()[0]
    space.shading.type, space.shading.color_type = shading, colour
    return space


def now(space):
    return space.shading.type, space.shading.color_type


@pytest.mark.parametrize("before", [("SOLID", "MATERIAL"), ("WIREFRAME", "OBJECT")])
def test_a_click_is_seen_and_off_leads_back(before):
    space = viewport(*before)
    viewport_shading.show(space, "ZEBRA")
    assert now(space)[0] == "MATERIAL" and viewport_shading.shows(space, "ZEBRA")
    viewport_shading.show(space, "MEAN")
    assert viewport_shading.shows(space, "MEAN")
    viewport_shading.show(space, "NONE")
    assert now(space) == before
    space.shading.type = "SOLID"
    viewport_shading.show(space, "NONE")
    assert now(space)[0] == "SOLID", "once only"


def test_zebra_in_edit_mode():
    one = add("One", *CUBE)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.object.fairing_inspect(mode="ZEBRA") == {"FINISHED"}
    modifier = inspection_modifier(one)
    assert modifier.show_viewport and modifier.show_in_editmode
    assert not bpy.ops.object.fairing_refresh.poll()
    bpy.ops.object.mode_set(mode="SCULPT")
    assert not bpy.ops.object.fairing_inspect.poll()
