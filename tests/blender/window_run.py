# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's hour in a real window: press the button, watch the progress, ESC, redo, undo."""

import os
import sys
from pathlib import Path
from time import perf_counter

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
import numpy as np

LONG = 5  # levels of Suzanne that take long enough to be watched
TOO_LONG = 7  # and to be cancelled
PATIENCE = 120.0  # seconds until a run must have ended


def sidebar_at_rest(name, unlike=None):
    """Brightness (h, w) of the sidebar once two pictures are equal, not `unlike`; a generator."""
    begun, last = perf_counter(), None
    while True:
        yield 0.5
        now = harness.pixels(name, harness.sidebar()).sum(axis=2, dtype=int)
        is_new = unlike is None or not np.array_equal(now, unlike)
        if is_new and last is not None and np.array_equal(now, last):
            (Path(os.environ["DF_SCREENSHOTS"]) / f"{name}.png").unlink()
            return now
        assert perf_counter() - begun < PATIENCE, "the sidebar does not come to rest"
        last = now


def find_button(settings):
    """The place of the button on the screen: only its text changes with this setting. A generator; returns (x, y)."""
    before = yield from sidebar_at_rest("button_before")
    settings.use_selection = True
    harness.sidebar().tag_redraw()
    after = yield from sidebar_at_rest("button_after", before)
    settings.use_selection = False
    yield 0.5
    rows, columns = np.nonzero(np.abs(after - before) > 127)
    assert len(rows), "the button's text has not changed"
    assert np.ptp(rows) < 40, "more than one line has changed"
    sidebar = harness.sidebar()
    return sidebar.x + int(columns.mean()), harness.top_of(sidebar) + int(rows.mean())


def press(settings):
    """Clicks the button Fair Surface with the mouse; a generator."""
    x, y = yield from find_button(settings)
    harness.xdotool("mousemove", x, y)
    yield 0.5
    harness.xdotool("click", 1)
    yield 0.3


def open_panel(levels):
    """Suzanne and the sidebar, as a user would have them; a generator that returns the source and the settings."""
    source = harness.add_suzanne()
    settings = bpy.context.scene.discrete_fairing
    settings.levels = levels
    yield from harness.open_sidebar("Fairing")
    return source, settings


def test_a_click_makes_the_surface():
    source, settings = yield from open_panel(3)
    yield from press(settings)
    yield from harness.until_it_ends()
    result = bpy.data.objects["Suzanne Fair"]
    assert bpy.context.view_layer.objects.active == result and source.hide_get()
    assert len(result.data.polygons) >= 500 * 4**3
    harness.photograph("result")


def test_progress_is_shown_and_the_surface_comes():
    _, settings = yield from open_panel(LONG)
    yield from press(settings)
    assert harness.running(), "a long run does not block"
    yield 1.0
    harness.photograph("progress")
    seen = yield from harness.until_it_ends()
    assert len({fraction for fraction, _ in seen}) > 3, f"progress was {seen}"
    assert len(bpy.data.objects["Suzanne Fair"].data.polygons) >= 500 * 4**LONG
    harness.undo()
    yield 0.5
    assert list(bpy.data.objects.keys()) == ["Suzanne"], "undone in one step"


def test_escape_leaves_the_scene_as_it_was():
    source, settings = yield from open_panel(TOO_LONG)
    meshes = set(bpy.data.meshes)
    yield from press(settings)
    yield 0.5
    assert harness.running()
    harness.xdotool("key", "Escape")
    yield from harness.until_it_ends()
    assert list(bpy.data.objects) == [source] and set(bpy.data.meshes) == meshes
    assert not source.hide_get() and source.select_get()
    yield from press(bpy.context.scene.discrete_fairing)
    assert harness.running(), "the button works again"
    harness.xdotool("key", "Escape")
    yield from harness.until_it_ends()


def test_redo_with_another_level_then_undo():
    _, settings = yield from open_panel(2)
    yield from press(settings)
    yield from harness.until_it_ends()
    yield 0.5
    faces = len(bpy.data.objects["Suzanne Fair"].data.polygons)
    prediction = harness.module("prediction")
    patience = prediction.PATIENCE
    prediction.PATIENCE = PATIENCE  # a busy machine is not to show fewer levels
    yield from harness.raise_levels(lambda: bpy.data.objects["Suzanne Fair"])
    there = bpy.data.objects
    yield from harness.until(lambda: len(there["Suzanne Fair"].data.polygons) == 4 * faces)
    yield 0.5
    prediction.PATIENCE = patience
    harness.photograph("redo")
    harness.undo()
    yield 0.5
    assert "Suzanne Fair" not in bpy.data.objects
    assert not bpy.data.objects["Suzanne"].hide_get()


def test_several_objects_queue():
    first = harness.add_suzanne()
    second = first.copy()
    second.data = first.data.copy()
    bpy.context.collection.objects.link(second)
    second.location.x = 4.0
    for source in (first, second):
        source.select_set(True)
    assert harness.call(bpy.ops.object.fairing_surface, "INVOKE_DEFAULT", levels=4) == {
        "RUNNING_MODAL"
    }
    assert harness.running().position == (1, 2)
    yield from harness.until_it_ends()
    assert {o.name for o in bpy.context.view_layer.objects.selected} == {
        "Suzanne Fair",
        "Suzanne.001 Fair",
    }


def start_long_run():
    """A run that would take minutes, begun."""
    harness.add_suzanne()
    with bpy.context.temp_override(**harness.view()):
        assert bpy.ops.object.fairing_surface("INVOKE_DEFAULT", levels=TOO_LONG) == {
            "RUNNING_MODAL"
        }
    assert harness.running()


def test_another_file_is_opened_meanwhile():
    start_long_run()
    yield 0.5
    harness.fresh_scene(empty=False)
    yield 0.5
    assert harness.running() is None, "the run ends with its file"
    _, settings = yield from open_panel(2)
    yield from press(settings)
    yield from harness.until_it_ends()
    assert "Suzanne Fair" in bpy.data.objects


def test_quitting_meanwhile():
    """The last one: Blender has to end by itself afterwards, which the time limit of the script sees to."""
    start_long_run()
    yield 0.5


harness.run_in_window(globals())
