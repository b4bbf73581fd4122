# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface follows when its source moves in Object Mode, unless somebody has moved the surface itself."""

import bpy
import pytest
from fake_layout import draw
from live_scenes import follow, live
from scenes import CUBE, activate, add, fair, recompute

from addon.live import handlers
from addon.surfaces.freshness import SOURCE_CHANGED, SOURCE_MOVED, why_stale
from addon.ui import main


def pair(**settings):
    source = add("Box", *CUBE)
    return source, fair(levels=1, **settings)


def height(target):
    bpy.context.view_layer.update()
    return target.dimensions.z


def move(source):
    source.location.x, source.rotation_euler.z = 5.0, 0.5
    follow()


def test_a_source_that_has_moved_is_told_and_followed():
    source, target = pair()
    assert why_stale(target) == ""
    move(source)
    assert why_stale(target) == SOURCE_MOVED and target.location.x == 0.0
    activate(target)
    assert "Out of date: source moved" in draw(main.VIEW3D_PT_fairing)
    recompute(target)
    follow()
    assert why_stale(target) == ""
    assert target.matrix_world == source.matrix_world


def test_a_surface_that_was_put_elsewhere_stays_there_and_still_takes_the_scale():
    source, target = pair()
    target.location.y = 4.0
    move(source)
    assert why_stale(target) == SOURCE_MOVED, "its rotation follows"
    recompute(target)
    follow()
    assert target.location[:] == (0.0, 4.0, 0.0)
    assert target.rotation_euler.z == source.rotation_euler.z
    source.location.x = 9.0
    follow()
    assert why_stale(target) == ""
    source.scale.z = 3.0
    follow()
    assert why_stale(target) in (SOURCE_MOVED, SOURCE_CHANGED)
    recompute(target)
    follow()
    assert target.location[:] == (0.0, 4.0, 0.0) and target.scale.z == 3.0
    assert height(target) > source.dimensions.z - 1e-5, "it passes through the vertices"


def test_it_can_be_left_where_it_is():
    source, target = pair()
    target.discrete_fairing.follow_transform = False
    move(source)
    assert why_stale(target) == ""
    recompute(target)
    follow()
    assert target.location.x == 0.0
    target.discrete_fairing.follow_transform = True
    assert why_stale(target) == SOURCE_MOVED


@pytest.mark.parametrize("parent", [False, True])
def test_live_follows_at_once(parent):
    source, target = pair()
    above = bpy.data.objects.new("Above", None)
    bpy.context.collection.objects.link(above)
    live(target)
    if parent:
        source.parent = above
        follow()
        above.location.z = 2.0
    move(source)
    source.scale.z = 3.0
    follow()
    follow()
    assert target.matrix_world == source.matrix_world and target.parent == source.parent
    assert height(target) > source.dimensions.z - 1e-5, "it passes through the vertices"
    target.location.x = -1.0
    source.location.x = 7.0
    follow()
    handlers.on_timer()
    assert target.location.x == -1.0


def test_what_constraints_do_is_followed():
    other = add("Other", *CUBE)
    source, target = pair()
    recompute(target)
    follow()
    source.constraints.new("COPY_LOCATION").target = other
    other.location.x = 2.0
    follow()
    assert why_stale(target) == SOURCE_MOVED
    recompute(target)
    follow()
    assert target.matrix_world.translation.x == 2.0 and why_stale(target) == ""
    other.location.x = 3.0
    follow()
    recompute(target)
    follow()
    assert target.matrix_world.translation.x == 3.0


@pytest.mark.parametrize("above", ["source", "target"])
def test_a_surface_with_another_parent_goes_its_own_way(above):
    source, target = pair()
    parents = (source, None) if above == "source" else (None, target)
    target.parent, source.parent = parents
    target.location.x = 2.0
    move(source)
    assert why_stale(target) == ""
    recompute(target)
    follow()
    assert target.location.x == 2.0 and (target.parent, source.parent) == parents


def test_an_animated_surface_is_left_to_its_animation():
    source, target = pair()
    target.location.x = 1.0
    target.keyframe_insert("location", frame=1)
    move(source)
    recompute(target)
    follow()
    assert target.location.x == 1.0
