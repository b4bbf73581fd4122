# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the sidebar of a real window."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness

READ = 30.0  # seconds until Blender must have read pictures, which it does beside drawing


def test_sidebar_shows_the_tab():
    assert harness.EXTENSION in bpy.context.preferences.addons
    yield from harness.open_sidebar("Fairing")
    sidebar = next(region for region in harness.view()["area"].regions if region.type == "UI")
    assert sidebar.active_panel_category == "Fairing", sidebar.active_panel_category
    picture = harness.photograph("panel")
    assert harness.colours(picture) > 100, "the window is not drawn"


def with_colours(name, before):
    """Until a picture has more colours than before, as pictures have; a generator."""
    yield from harness.photograph_until(name, lambda path: harness.colours(path) > before, READ)


def test_presets_are_chosen_by_pictures():
    yield from harness.open_sidebar("Fairing")
    before = harness.colours(harness.photograph("presets"))
    region = harness.view()["region"]
    harness.xdotool("mousemove", region.x + region.width // 2, region.y + region.height // 2)
    yield 0.5
    harness.call(bpy.ops.wm.call_panel, name="VIEW3D_PT_fairing_presets")
    yield from with_colours("presets", before)
    harness.xdotool("key", "Escape")
    yield 0.5


harness.run_in_window(globals())
