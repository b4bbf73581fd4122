# SPDX-License-Identifier: GPL-3.0-or-later
"""Live in a real window: vertices are grabbed with keyboard and mouse, and the surface follows."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
import numpy as np

MOVES = 24  # of the mouse, in one grab


def session(target):
    return harness.module("live.registry").session_of(target)


def positions(mesh):
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def positions_of(source):
    """Positions of the control vertices from the mesh, which has no attribute for them in Edit Mode."""
    values = np.empty(3 * len(source.data.vertices), np.float32)
    source.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def wait_for_the_full_level(target, level):
    """Until the surface is shown at that level and nothing is waiting; a generator."""
    yield from harness.until(
        lambda: not session(target).is_waiting and session(target).level == level
    )
    yield 0.3


def open_scene(levels, live_levels):
    """Suzanne with a live surface, in Edit Mode with one vertex selected; a generator that returns both objects."""
    source = harness.add_suzanne()
    bpy.context.scene.discrete_fairing.levels = levels
    yield from harness.open_sidebar("Fairing")
    assert harness.call(bpy.ops.object.fairing_live) == {"FINISHED"}
    target = bpy.data.objects[f"{source.name} Fair"]
    target.discrete_fairing_live.levels = live_levels
    yield from wait_for_the_full_level(target, levels)
    harness.call(bpy.ops.ed.undo_push, message="live")
    harness.select_vertex(source, 285)
    yield 0.5
    return source, target


def centre():
    """The middle of the viewport on the screen."""
    view = harness.view()
    region, height = view["region"], view["window"].height
    return region.x + region.width // 2, height - region.y - region.height // 2


def grab(target):
    """G, and the mouse from place to place; a generator that returns the number of updates. The grab goes on."""
    x, y = centre()
    harness.xdotool("mousemove", x, y)
    yield 0.3
    harness.xdotool("key", "g")
    yield 0.3
    seen = session(target).updates
    for step in range(MOVES):
        harness.xdotool("mousemove", x + 3 * step, y - 2 * step)
        yield 0.05
    yield 0.5
    return session(target).updates - seen


def test_a_grab_is_followed_and_the_full_level_comes_after():
    source, target = yield from open_scene(4, 3)
    before = positions(target.data)[: len(source.data.vertices)]
    updates = yield from grab(target)
    assert updates > MOVES // 4, f"{updates} updates"
    assert session(target).level <= 3, "the live level while the mouse drags"
    assert session(target).is_waiting and not session(target).full_text, "and it stays so"
    harness.photograph("live")
    source.update_from_editmode()
    moved = positions(target.data)[: len(before)]
    assert np.abs(moved - before).max() > 0.05
    harness.xdotool("click", 1)
    yield from wait_for_the_full_level(target, 4)
    assert source.mode == "EDIT"
    source.update_from_editmode()
    assert np.array_equal(positions(target.data)[: len(before)], positions_of(source)), (
        "through its vertices"
    )
    harness.photograph("live_full")
    harness.undo()
    source, target = bpy.data.objects["Suzanne"], bpy.data.objects["Suzanne Fair"]
    yield from wait_for_the_full_level(target, 4)
    source.update_from_editmode()
    assert np.array_equal(positions(target.data)[: len(before)], positions_of(source))
    assert np.array_equal(positions_of(source), before), "undone"


def test_rendering_meanwhile():
    source, target = yield from open_scene(3, 2)
    harness.call(bpy.ops.object.mode_set, mode="OBJECT")
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    source.data.vertices[0].co.z += 1.0
    source.data.update()
    harness.call(bpy.ops.render.render)
    yield from wait_for_the_full_level(target, 3)
    assert np.array_equal(positions(target.data)[0], positions_of(source)[0])


def test_quitting_while_live():
    """The last one: Blender has to end by itself afterwards, which the time limit of the script sees to."""
    _, target = yield from open_scene(5, 2)
    target.discrete_fairing.metric_exponent = 1.0
    yield from harness.until(lambda: session(target).full_text)


harness.run_in_window(globals())
