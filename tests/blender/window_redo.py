# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjust Last Operation with a large surface: a small one at once, the whole one by Recompute."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

SUZANNE = 500  # faces that she has at least


def surface():
    return bpy.data.objects["Suzanne Fair"]


def first_surface(levels):
    """Suzanne and her surface, made by way of Blender's search; a generator."""
    harness.add_suzanne()
    bpy.context.scene.discrete_fairing.levels = levels
    region = harness.view()["region"]
    harness.xdotool("mousemove", region.x + region.width // 2, region.y + region.height // 2)
    yield 0.5
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.wm.search_menu("INVOKE_DEFAULT")  # F3
    yield 1.5
    harness.xdotool("type", "Fair Surface")
    yield 1.5
    harness.photograph("search")
    harness.xdotool("key", "Return")
    yield from harness.until(lambda: "Suzanne Fair" in bpy.data.objects)
    yield 2.0


def test_redo_shows_a_small_surface_and_recompute_the_whole_one():
    yield from first_surface(2)
    prediction = harness.module("prediction")
    with harness.event_log() as log:
        for level in (3, 4):
            prediction.note("THIN_PLATE", 1000, 1.0, None)  # a slow machine
            prediction._of_mesh.clear()  # the small surface before has shown that it is fast
            yield from harness.raise_levels(surface)
            yield from harness.until(lambda level=level: surface().discrete_fairing.levels == level)
            yield 0.5
            assert len(surface().data.polygons) < SUZANNE * 4**2, "it has waited for the whole one"
    print(f"longest stop of the window in the meantime: {max(gap for _, gap in log):.2f} s")
    harness.photograph("redo_small")
    assert surface().discrete_fairing.unfinished
    harness.call(bpy.ops.object.fairing_recompute, "INVOKE_DEFAULT", True)
    yield from harness.until(lambda: not surface().discrete_fairing.unfinished)
    assert len(surface().data.polygons) >= SUZANNE * 4**4
    for _ in range(2):
        harness.undo()
        yield 1.0
    assert not [o for o in bpy.data.objects if o.name.startswith("Suzanne F")], "a step each"


harness.run_in_window(globals())
