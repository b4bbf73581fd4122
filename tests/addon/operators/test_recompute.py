# SPDX-License-Identifier: GPL-3.0-or-later
"""Recompute, and the way from a surface to its source."""

import bpy
import numpy as np
from fake_layout import draw
from live_scenes import live, move
from scenes import CUBE, activate, add, again, fair, positions, recompute, refused

from addon.live import handlers
from addon.memory import why_unfit
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


def test_surfaces_selected_beside_a_mesh_are_not_faired_a_second_time(source):
    surface = fair(levels=1)
    other = add("Other", *CUBE)
    activate(surface, other)
    assert "768 triangles" in " ".join(map(str, draw(main.VIEW3D_PT_fairing)))
    made = fair(levels=2)
    assert made.name == "Other Fair" and bpy.context.selected_objects == [made]
    assert {o.name for o in bpy.data.objects} == {"Box", "Box Fair", "Other", "Other Fair"}
    activate(surface)
    assert len(fair(levels=1).data.polygons) == 6 * 4 * 4, "alone, it is a mesh like any other"


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


def test_no_ring_of_sources(source):
    first = fair(levels=1)
    second = fair(levels=1)
    assert not why_unfit(second, first), "a chain will do"
    source.discrete_fairing.source = second
    for surface in (source, first, second):
        activate(surface)
        assert not bpy.ops.object.fairing_recompute.poll()


def test_the_panel_of_a_source_has_the_settings_of_what_follows_it(source):
    target = live(source)
    activate(source)
    scene, log = bpy.context.scene.discrete_fairing, draw(main.VIEW3D_PT_fairing)
    assert f"Live: {target.name}" in log and "object.fairing_surface" not in log
    settings = main.active_settings(bpy.context)
    assert settings == target.discrete_fairing != scene
    before = positions(target.data)
    settings.energy = "TOTAL_CURVATURE"
    handlers.on_timer()
    assert not np.array_equal(positions(target.data), before)
    bpy.ops.object.fairing_live()
    assert "object.fairing_surface" in draw(main.VIEW3D_PT_fairing)
    assert main.active_settings(bpy.context) == scene
