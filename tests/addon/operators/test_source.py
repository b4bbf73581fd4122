# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that can be the source of a surface, and the messages for those that cannot."""

import bpy
import numpy as np
from fake_layout import draw
from live_scenes import live, pull, session
from scenes import CUBE, activate, add, fair, positions, refused

from addon.live import handlers
from addon.memory import why_unfit
from addon.ui import main


def add_camera():
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    return camera


def test_a_camera_is_refused_in_words():
    add("Box", *CUBE)
    target = fair(levels=1)
    assert not why_unfit(target, target.discrete_fairing.source)
    target.discrete_fairing.source = camera = add_camera()
    assert "is not a mesh" in why_unfit(target, camera)
    log = draw(main.VIEW3D_PT_fairing)
    assert any("not a mesh" in line for line in log)
    for operator in (bpy.ops.object.fairing_recompute, bpy.ops.object.fairing_show_source):
        assert not operator.poll()
    refused("is not a mesh", bpy.ops.object.fairing_recompute)


def test_no_surface_is_its_own_source(source):
    target = live(source)
    target.discrete_fairing.source = target
    activate(target)
    faces = len(target.data.polygons)
    for _ in range(3):
        pull(target)
    assert len(target.data.polygons) == faces, "Live refines no output of its own"
    assert session(target) is None and "itself" in target.discrete_fairing_live.status
    assert not bpy.ops.object.fairing_recompute.poll()


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
    bpy.ops.object.fairing_live(state="OFF")
    assert "object.fairing_surface" in draw(main.VIEW3D_PT_fairing)
    assert main.active_settings(bpy.context) == scene
