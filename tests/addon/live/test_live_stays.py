# SPDX-License-Identifier: GPL-3.0-or-later
"""Live over frames, renders and files, and the display of its cage."""

import bpy
import pytest
from live_scenes import box, live, pull, session, through
from scenes import CUBE, activate, add, again, positions, reopen

from addon.live import restored

FRAMES = (1, 11)


def animate(source):
    """A shape key that raises a vertex by one from the first frame to the last."""
    source.shape_key_add(name="Basis")
    key = source.shape_key_add(name="Up")
    key.data[0].co.z += 1.0
    for frame, value in zip(FRAMES, (0.0, 1.0), strict=True):
        key.value = value
        key.keyframe_insert("value", frame=frame)


def drive(source):
    """A driver moves a vertex: a modifier whose strength follows the frame."""
    modifier = source.modifiers.new("Displace", "DISPLACE")
    modifier.direction, modifier.mid_level = "Z", 0.0
    driver = modifier.driver_add("strength").driver
    driver.type, driver.expression = "SCRIPTED", "(frame - 1) / 10"


def animated(way):
    source = add("Box", *CUBE)
    way(source)
    activate(source)
    bpy.context.scene.discrete_fairing.mesh_source = "EVALUATED"
    bpy.context.scene.frame_set(FRAMES[0])
    return live(source)


@pytest.mark.parametrize("hidden", [False, True])
@pytest.mark.parametrize("way", [animate, drive])
def test_frames_are_followed(way, hidden):
    """Without a window no timer comes back to a source that Blender does not evaluate."""
    target = animated(way)
    target.discrete_fairing.source.hide_viewport = hidden
    before = positions(target.data)[0, 2]
    for frame in (6, 11, 1):
        bpy.context.scene.frame_set(frame)
        height = positions(target.data)[0, 2] - before
        assert height == pytest.approx((frame - 1) / 10, abs=0.3), "keys ease in and out"
        assert (height != 0.0) == (frame != 1)


@pytest.mark.parametrize("on", [False, True])
def test_files_keep_it_where_it_is_on_in_renders(tmp_path, on):
    source, target = box()
    target.discrete_fairing_live.in_renders = on
    reopen(tmp_path)
    target = bpy.data.objects["Box Fair"]
    target.discrete_fairing.source.display_type = "WIRE"
    target.discrete_fairing_live.cage_display = "TEXTURED"
    restored._restore()
    assert target.discrete_fairing_live.on == on
    assert (target.discrete_fairing.source.display_type == "WIRE") == on
    if on:
        source = bpy.data.objects["Box"]
        pull(source)
        assert through(target, source)


def test_the_cage_is_wire_while_it_is_live():
    source, target = box()
    assert source.display_type == "WIRE"
    target.discrete_fairing_live.cage_as_wire = False
    assert source.display_type == "TEXTURED"
    target.discrete_fairing_live.cage_as_wire = True
    target.discrete_fairing_live.on = False
    assert source.display_type == "TEXTURED" and session(target) is None
    target.discrete_fairing_live.on = True
    source.display_type = "BOUNDS"
    target.discrete_fairing_live.on = False
    assert source.display_type == "BOUNDS", "who has changed it meanwhile is right"


def test_the_last_of_several_surfaces_gives_the_cage_back():
    source, first = box()
    second = live(again(source, levels=1))
    first.discrete_fairing_live.on = False
    assert source.display_type == "WIRE"
    second.discrete_fairing_live.on = False
    assert source.display_type == "TEXTURED"
