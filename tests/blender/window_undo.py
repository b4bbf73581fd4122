# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo beside runs that write outside of any step, and the things that a run must leave alone in a window."""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness


def surface():
    return bpy.data.objects.get("Suzanne Fair")


def press(operator, **properties):
    """As a button does it."""
    return harness.call(operator, "INVOKE_DEFAULT", True, **properties)


def begin_run(energy):
    """One in the background, as on a slow machine."""
    harness.module("prediction").note(energy, 1000, 1.0, None)
    settings = bpy.context.scene.discrete_fairing
    settings.levels, settings.energy = 3, energy
    press(bpy.ops.object.fairing_surface)
    assert harness.running() is not None


def test_a_run_over_two_workspaces():
    harness.add_suzanne()
    begin_run("TOTAL_CURVATURE")
    yield 0.3
    window = bpy.context.window_manager.windows[0]
    window.workspace = bpy.data.workspaces["Modeling"]
    yield from harness.until(surface)
    yield 0.5
    harness.photograph("status_of_the_other_workspace")
    window.workspace = bpy.data.workspaces["Layout"]
    yield 1.0
    harness.photograph("status_of_the_first_workspace")
    assert harness.running() is None


def test_overlays_begin_where_blender_opens_with_a_file():
    overlays = [harness.module("inspection.overlay"), harness.module("strain.overlay")]
    assert all(overlay.is_on() for overlay in overlays)
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "start.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        for overlay in overlays:
            overlay.unregister()
            overlay.register()
        bpy.ops.wm.open_mainfile(filepath=path)
        yield from harness.until(lambda: all(overlay.is_on() for overlay in overlays))


harness.run_in_window(globals())
