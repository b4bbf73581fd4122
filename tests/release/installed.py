# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension as a repository brought it: it works, and its user makes what an update has to keep."""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
from what_is_kept import EXTENSION, FILE, FOLDER, PRESET, THREADS, the_version


def test_it_is_enabled_with_the_version_of_the_repository():
    assert EXTENSION in bpy.context.preferences.addons
    assert the_version() == os.environ["DF_VERSION"], the_version()


def test_a_surface_is_made_and_kept_in_a_file():
    bpy.ops.mesh.primitive_cube_add()
    assert bpy.ops.object.fairing_surface(levels=2) == {"FINISHED"}
    surface = bpy.context.active_object
    assert surface.name == "Cube Fair" and len(surface.data.polygons) == 6 * 16
    bpy.ops.wm.save_as_mainfile(filepath=str(FILE))


def keep_preset():
    """Saves the panel's settings as the user's preset.

    Blender 4.3's own saving of presets fails with Python 3.13, which only Debian builds it with: there the file is
    written as Blender would."""
    if sys.version_info < (3, 13) or bpy.app.version >= (5, 1):
        bpy.context.scene.discrete_fairing.tolerance = 0.125
        bpy.ops.object.fairing_preset_add(name=PRESET)
        return
    folder = Path(bpy.utils.user_resource("SCRIPTS", path=FOLDER, create=True))
    lines = ["import bpy", "op = bpy.context.active_operator", "op.tolerance = 0.125", ""]
    (folder / f"{PRESET}.py").write_text("\n".join(lines))


def test_a_preset_and_preferences_are_kept():
    keep_preset()
    bpy.context.preferences.addons[EXTENSION].preferences.threads = THREADS
    bpy.ops.wm.save_userpref()


harness.run(globals())
