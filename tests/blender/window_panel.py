# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the sidebar of a real window."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness


def test_sidebar_shows_the_tab():
    assert harness.EXTENSION in bpy.context.preferences.addons
    yield from harness.open_sidebar("Fairing")
    sidebar = next(region for region in harness.view()["area"].regions if region.type == "UI")
    assert sidebar.active_panel_category == "Fairing", sidebar.active_panel_category
    picture = harness.photograph("panel")
    assert harness.colours(picture) > 100, "the window is not drawn"


harness.run_in_window(globals())
