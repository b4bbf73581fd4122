# SPDX-License-Identifier: GPL-3.0-or-later
"""What the stages have in common: the extension, and what its user made."""

import os
import sys
from pathlib import Path

import bpy

EXTENSION = os.environ["DF_EXTENSION"]
USER = Path(bpy.utils.resource_path("USER"))
FILE = USER / "cube.blend"
FOLDER = "presets/operator/object.fairing_surface"
PRESET, THREADS = "mine", 5


def the_version():
    """The version in the manifest of the extension that Blender has enabled."""
    import tomllib

    folder = Path(sys.modules[EXTENSION].__file__).parent
    return tomllib.loads((folder / "blender_manifest.toml").read_text())["version"]
