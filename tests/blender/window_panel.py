# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the sidebar of a real window."""

import importlib
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
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.wm.call_panel(name="VIEW3D_PT_fairing_presets")
    yield from with_colours("presets", before)
    harness.xdotool("key", "Escape")
    yield 0.5


class VIEW3D_PT_unfolded(bpy.types.Panel):
    """What stands folded under More, unfolded: no script can click on a fold."""

    bl_label = "More"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Fairing"

    def draw(self, context):
        layout = importlib.import_module(f"{harness.EXTENSION}.ui.layout")
        self.layout.use_property_split = True
        layout.draw_shape(self.layout, context.scene.discrete_fairing)


def test_choices_have_pictures():
    pictures = importlib.import_module(f"{harness.EXTENSION}.ui.pictures")
    assert pictures.icon("THIN_PLATE") and pictures.icon("LIMIT") and pictures.icon("HULL")
    yield from harness.open_sidebar("Fairing")
    before = harness.colours(harness.photograph("choices"))
    bpy.utils.register_class(VIEW3D_PT_unfolded)
    yield from with_colours("choices", before)
    bpy.utils.unregister_class(VIEW3D_PT_unfolded)
    yield 0.5


harness.run_in_window(globals())
