# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension after its update: the next version works, with all that its user made."""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
from what_is_kept import EXTENSION, FILE, FOLDER, PRESET, THREADS, the_version


def test_the_next_version_is_enabled():
    assert EXTENSION in bpy.context.preferences.addons
    assert the_version() == os.environ["DF_VERSION"], the_version()


def test_preferences_are_kept():
    assert bpy.context.preferences.addons[EXTENSION].preferences.threads == THREADS


def test_the_preset_is_offered_and_applied():
    folders = bpy.utils.preset_paths(FOLDER.removeprefix("presets/"))
    (path,) = (p for folder in folders for p in Path(folder).glob(f"{PRESET}.py"))
    settings = bpy.context.scene.discrete_fairing
    assert settings.tolerance != 0.125
    assert bpy.ops.object.fairing_preset_apply(filepath=str(path)) == {"FINISHED"}
    assert settings.tolerance == 0.125


def test_the_file_opens_and_its_surface_is_made_anew():
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    surface = bpy.data.objects["Cube Fair"]
    assert surface.discrete_fairing.levels == 2
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    bpy.ops.object.select_all(action="DESELECT")
    bpy.data.objects["Cube"].select_set(True)
    assert bpy.ops.object.fairing_surface(levels=1) == {"FINISHED"}


harness.run(globals())
