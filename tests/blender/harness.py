# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts in this folder share: they run inside a real Blender, which knows no test framework.

A script ends with `harness.run(globals())`, or `harness.run_in_window(globals())`. Every function named `test_…` is
run in a fresh scene; `PASS name`, or `FAIL name`, with its seconds is printed for it and `RAN n` at the end, which
build_tools/blender_suite.py counts. In a window a test may be a generator: at each `yield SECONDS` the window gets
that time to draw and to take events."""

import contextlib
import importlib
import inspect
import os
import subprocess
import sys
import traceback
from pathlib import Path
from time import perf_counter

import bmesh
import bpy
import numpy as np

EXTENSION = "bl_ext.user_default.discrete_fairing"
_BUTTON = 12  # pixels: less than a button is high
DRAWN = 120.0  # seconds until an area must have been drawn: on a busy machine it takes its time


def module(name):
    """A module of the extension."""
    return importlib.import_module(f"{EXTENSION}.{name}")


def until(done, patience=120.0):
    """Waits until `done()`, at most `patience` seconds; a generator."""
    begun = perf_counter()
    while not done():
        assert perf_counter() - begun < patience, "it does not come"
        yield 0.05


def running():
    """The extension's queue at work, or None."""
    return module("queue").running()


def until_it_ends(patience=300.0):
    """Waits for the run; a generator that returns its (fraction, phase) each time that the window had its turn."""
    begun, seen = perf_counter(), []
    while running():
        assert perf_counter() - begun < patience, "the run does not end"
        seen.append((running().fraction, running().phase))
        yield 0.05
    yield 0.5
    return seen


def fresh_scene(empty=True):
    """The start-up scene, or an empty one; the enabled extension stays."""
    bpy.ops.wm.read_homefile(use_empty=empty, use_factory_startup=False)


def tests_in(namespace):
    """The test functions of a script, in its order."""
    return {name: test for name, test in namespace.items() if name.startswith("test_")}


def steps(test):
    """Runs a test that may be a generator; yields the seconds that it wants to wait."""
    result = test()
    if inspect.isgenerator(result):
        yield from result


def report(name, start, error=None):
    """The line of one test that began at `start`; True if it passed."""
    if error is not None:
        traceback.print_exception(error, file=sys.stdout)
    print(f"{'FAIL' if error else 'PASS'} {name} {perf_counter() - start:.2f} s", flush=True)
    return error is None


def run(namespace):
    """Every test in a scene of its own, without a window; then the process ends, with 1 if any failed."""
    passed = []
    for name, test in tests_in(namespace).items():
        start = perf_counter()
        try:
            fresh_scene()
            test()
        except Exception as error:
            passed.append(report(name, start, error))
        else:
            passed.append(report(name, start))
    print(f"RAN {len(passed)}", flush=True)
    sys.exit(0 if all(passed) else 1)


def run_in_window(namespace):
    """Every test in a scene of its own, from a timer, so that the window lives between the steps; then Blender quits.

    The timer must not end with an exception: Blender would stay open until its time is up.
    """
    bpy.context.preferences.view.show_splash = False
    walk = _walk_in_window(tests_in(namespace))
    # persistent: loading a scene would remove it
    bpy.app.timers.register(lambda: next(walk, None), first_interval=0.5, persistent=True)


def drawn(space=bpy.types.SpaceView3D):
    """Waits until an area of this kind has been drawn: operators that turn a viewport ask for sizes and matrices, and
    Blender crashes if a file browser runs before that. A generator. At first there is no window: it opens after the
    scripts have been read."""
    begun, seen = perf_counter(), []
    handle = space.draw_handler_add(lambda: seen.append(True), (), "WINDOW", "POST_PIXEL")
    while not seen and perf_counter() - begun < DRAWN:
        yield 0.1
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                area.tag_redraw()
    space.draw_handler_remove(handle, "WINDOW")
    assert seen, f"no {space.__name__} was drawn within {DRAWN:.0f} s"


def _walk_in_window(tests):
    with contextlib.suppress(AssertionError):
        yield from drawn()
    for name, test in tests.items():
        start = perf_counter()
        try:
            fresh_scene(empty=False)
            yield from drawn()
            yield 0.2
            yield from steps(test)
        except Exception as error:
            report(name, start, error)
            with contextlib.suppress(OSError, subprocess.SubprocessError):
                photograph(f"failed_{name}")
        else:
            report(name, start)
    print(f"RAN {len(tests)}", flush=True)
    bpy.ops.wm.quit_blender()


def view():
    """The 3D viewport of the one window: window, screen, area and region, as temp_override takes them."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "screen": window.screen, "area": area, "region": region}


def call(operator, *how, target=None, **properties):
    """Calls an operator in the viewport; only `target` is selected and active, if it is given."""
    alone = {"active_object": target, "object": target, "selected_objects": [target]}
    with bpy.context.temp_override(**view(), **(alone if target else {})):
        return operator(*how, **properties)


@contextlib.contextmanager
def event_log():
    """Inside the `with` the list gets (when, seconds since the last one) at each timer event of the window."""
    log, last = [], [perf_counter()]

    def tick():
        now = perf_counter()
        log.append((now, now - last[0]))
        last[0] = now
        return 0.01

    bpy.app.timers.register(tick)
    try:
        yield log
    finally:
        bpy.app.timers.unregister(tick)


def undo():
    call(bpy.ops.ed.undo)


def select_vertex(source, vertex):
    """Selects one vertex of the active object in Edit Mode, as a step of undo."""
    with bpy.context.temp_override(**view()):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="VERT")
        bpy.ops.mesh.select_all(action="DESELECT")
        edit = bmesh.from_edit_mesh(source.data)
        edit.verts.ensure_lookup_table()
        edit.verts[vertex].select_set(True)
        bmesh.update_edit_mesh(source.data)
        bpy.ops.ed.undo_push(message="one vertex is selected")


def add_suzanne():
    """Suzanne, alone in the scene, with the viewport before her; for a window."""
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    with bpy.context.temp_override(**view()):
        bpy.ops.mesh.primitive_monkey_add(size=4)
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITRIGHT")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Suzanne is there")
    return bpy.data.objects["Suzanne"]


def open_sidebar(category):
    """Opens the viewport's sidebar at a tab; a generator, as the sidebar has to be drawn once before."""
    view()["area"].spaces.active.show_region_ui = True
    yield 0.5
    sidebar().active_panel_category = category
    sidebar().tag_redraw()
    yield 0.5


def photograph(name):
    """Saves a picture of the screen, as X shows it; Blender's operator gives a black one here."""
    path = Path(os.environ["DF_SCREENSHOTS"]) / f"{name}.png"
    subprocess.run(["import", "-window", "root", path], check=True, timeout=60)
    return path


def top_of(region):
    """The first row of a region on the screen."""
    return view()["window"].height - region.y - region.height


def pixels(name, region=None):
    """(h, w, 3) uint8 of a region, by default the viewport, as X shows it."""
    path, region = photograph(name), region or view()["region"]
    crop = f"{region.width}x{region.height}+{region.x}+{top_of(region)}"
    command = ["convert", path, "-crop", crop, "-depth", "8", "rgb:-"]
    done = subprocess.run(command, check=True, capture_output=True, timeout=60)
    return np.frombuffer(done.stdout, np.uint8).reshape(region.height, region.width, 3)


def photograph_until(name, is_ready, patience):
    """Takes pictures until `is_ready(path)`: pictures and shaders are read beside drawing. A generator."""
    begun = perf_counter()
    while not is_ready(photograph(name)):
        assert perf_counter() - begun < patience, f"{name} is not as it should be"
        view()["area"].tag_redraw()
        yield 0.5


def colours(path):
    """How many colours a picture has."""
    found = subprocess.run(
        ["identify", "-format", "%k", path], capture_output=True, check=True, text=True, timeout=60
    )
    return int(found.stdout)


def execute_browser(path=None):
    """Presses the button of the file browser, with this file if it is given; a generator."""
    yield from drawn(bpy.types.SpaceFileBrowser)
    window, area = next(
        (window, area)
        for window in bpy.context.window_manager.windows
        for area in window.screen.areas
        if area.type == "FILE_BROWSER"
    )
    region = next(region for region in area.regions if region.type == "WINDOW")
    if path:
        area.spaces.active.params.directory = str(path.parent).encode()
        area.spaces.active.params.filename = path.name
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.file.execute()


def xdotool(*words):
    """Controls mouse and keyboard of the X server."""
    subprocess.run(["xdotool", *map(str, words)], check=True, timeout=30)


def sidebar():
    """The region of the sidebar."""
    return next(region for region in view()["area"].regions if region.type == "UI")


def button_at(region, x, y):
    """The Python call of the button at a place, as Blender would copy it; a generator."""
    manager = bpy.context.window_manager
    xdotool("mousemove", x, y)
    yield 0.1
    manager.clipboard = ""
    with bpy.context.temp_override(**{**view(), "region": region}):
        if bpy.ops.ui.copy_python_command_button.poll():
            with contextlib.suppress(RuntimeError):
                bpy.ops.ui.copy_python_command_button()
    return manager.clipboard


def find_button(region, call, share, below):
    """The place on the screen of the button whose call begins with `call`, such as
    "bpy.ops.object.fairing_for(purpose='HULL'". The search goes up and down from `below`, in pixels from the top of
    the region, at a `share` of its width. A generator."""
    top, x = top_of(region), int(region.x + share * region.width)
    steps = sorted(range(_BUTTON, region.height, _BUTTON), key=lambda y: abs(y - below))
    for y in steps:
        found = yield from button_at(region, x, top + y)
        if found.startswith(call):
            return x, top + y
    raise AssertionError(f"there is no button {call}")


class Clicks:
    """Presses buttons of the sidebar as a user does, and counts."""

    def __init__(self):
        self.count = 0

    def press(self, call, share, below):
        """One click on a button; a generator. The search for it is not counted, since users see it."""
        place = yield from find_button(sidebar(), call, share, below)
        xdotool("mousemove", *place)
        yield 0.3
        xdotool("click", 1)
        self.count += 1
        yield 0.5


def redo_panel():
    """The region of Adjust Last Operation."""
    return next(region for region in view()["area"].regions if region.type == "HUD")


def line_of(region, number):
    """The place on the screen of a value in a panel's line; the title is line 0."""
    unit = bpy.context.preferences.system.ui_scale
    return int(region.x + 0.75 * region.width), int(top_of(region) + (20 + 24 * number) * unit)


def unfold():
    """Opens Adjust Last Operation, where it is closed, by a click on its title; a generator. A busy machine may
    lose the click, or open the panel late: no second click before that is sure."""
    assert redo_panel().width > 50, "Adjust Last Operation is not shown"
    for _ in range(5):
        if redo_panel().height >= 60:
            return
        xdotool("mousemove", *line_of(redo_panel(), 0))
        yield 1.0
        xdotool("click", 1)
        for _ in range(20):
            yield 0.25
            if redo_panel().height >= 60:
                break
    raise AssertionError("Adjust Last Operation does not open")


def raise_levels(surface):
    """Ctrl and the wheel over Levels in Adjust Last Operation, until what `surface()` finds has one more; a
    generator. A busy machine takes its time to notice where the mouse is."""
    before = surface().discrete_fairing.levels
    yield from unfold()
    for way in range(10):
        x, y = line_of(redo_panel(), 2)  # line 1 has the presets
        xdotool("mousemove", x + way % 3, y)
        yield 1.5
        xdotool("keydown", "ctrl", "click", 4, "keyup", "ctrl")  # raises a number under the mouse
        for _ in range(12):  # a second click that comes before the first redo would raise it twice
            yield 0.5
            if surface().discrete_fairing.levels > before:
                return
    photograph("levels_do_not_change")
    raise AssertionError("the number of levels does not change")
