# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender after the extension was removed: it knows nothing of it, and opens the files that were made with it."""

import importlib.util
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
from what_is_kept import EXTENSION, FILE


def test_blender_knows_neither_extension_nor_package():
    assert EXTENSION not in bpy.context.preferences.addons
    assert not hasattr(bpy.types, "OBJECT_OT_fairing_surface")
    assert importlib.util.find_spec("discrete_fairing") is None


def test_the_file_still_opens_with_its_surface():
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    assert len(bpy.data.objects["Cube Fair"].data.polygons) == 6 * 16


harness.run(globals())
