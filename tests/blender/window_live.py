# SPDX-License-Identifier: GPL-3.0-or-later
"""Live in a real window: vertices are grabbed with keyboard and mouse, and the surface follows. Prints how long updates take."""

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


def add_torus():
    """A torus in the place of Suzanne: where total curvature takes few steps."""
    bpy.data.objects.remove(harness.add_suzanne())
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.mesh.primitive_torus_add(
            major_segments=24, minor_segments=16, major_radius=1.5, minor_radius=0.5
        )
    return bpy.context.view_layer.objects.active


def open_scene(levels, live_levels, energy="THIN_PLATE", add=harness.add_suzanne, vertex=285):
    """A mesh with a live surface, in Edit Mode with one vertex selected; a generator that returns both objects."""
    source = add()
    settings = bpy.context.scene.discrete_fairing
    settings.levels, settings.energy = levels, energy
    yield from harness.open_sidebar("Fairing")
    assert harness.call(bpy.ops.object.fairing_live) == {"FINISHED"}
    target = bpy.data.objects[f"{source.name} Fair"]
    target.discrete_fairing_live.levels = live_levels
    yield from wait_for_the_full_level(target, levels)
    harness.call(bpy.ops.ed.undo_push, message="live")
    harness.select_vertex(source, vertex)
    yield 0.5
    return source, target


def centre():
    """The middle of the viewport on the screen."""
    view = harness.view()
    region, height = view["region"], view["window"].height
    return region.x + region.width // 2, height - region.y - region.height // 2


class Recorder:
    """Notes the parts of each update; the time between two redraws is the whole update."""

    def __init__(self, target):
        self.session, self.parts, self.seen = session(target), [], session(target).updates
        self._handle = bpy.types.SpaceView3D.draw_handler_add(self._note, (), "WINDOW", "POST_VIEW")

    def _note(self):
        if self.session.updates != self.seen:
            self.seen = self.session.updates
            self.parts.append(dict(self.session.parts))

    def stop(self):
        bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
        return self.parts


def grab(target):
    """G, and the mouse from place to place; a generator that returns the parts of the updates. The grab goes on."""
    x, y = centre()
    harness.xdotool("mousemove", x, y)
    yield 0.3
    harness.xdotool("key", "g")
    yield 0.3
    recorder = Recorder(target)
    for step in range(MOVES):
        harness.xdotool("mousemove", x + 3 * step, y - 2 * step)
        yield 0.05
    yield 0.5
    return recorder.stop()


def told(what, parts):
    """Prints the middle of each part over the updates; the first has to build."""
    kept = parts[1:]
    middle = {name: float(np.median([update[name] for update in kept])) for name in kept[0]}
    whole = [sum(update.values()) for update in kept]
    text = ", ".join(f"{name} {value:.2f}" for name, value in middle.items())
    print(
        f"live, {what}: {text}; whole {np.median(whole):.2f}, worst {max(whole):.2f} ms of {len(kept)}"
    )


def test_a_grab_is_followed_and_the_full_level_comes_after():
    source, target = yield from open_scene(4, 3)
    before = positions(target.data)[: len(source.data.vertices)]
    parts = yield from grab(target)
    assert len(parts) > MOVES // 4, f"{len(parts)} updates were seen"
    assert session(target).level <= 3, "the live level while the mouse drags"
    assert session(target).is_waiting and not session(target).full_text, "and it stays so"
    harness.photograph("live")
    source.update_from_editmode()
    moved = positions(target.data)[: len(before)]
    assert np.abs(moved - before).max() > 0.05
    told(f"thin plate, {session(target).triangles} triangles", parts)
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


def test_total_curvature_is_followed():
    source, target = yield from open_scene(3, 3, "TOTAL_CURVATURE", add_torus, 0)
    parts = yield from grab(target)
    harness.xdotool("key", "Escape")
    assert len(parts) > 2, f"{len(parts)} updates were seen"
    told(f"total curvature, {session(target).triangles} triangles", parts)
    yield from wait_for_the_full_level(target, 3)


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
