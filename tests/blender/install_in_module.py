# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the extension's zip in Blender as a Python module, as its own preferences do, and runs a script on it.

    python3 tests/blender/install_in_module.py ZIP [SCRIPT]

For official builds, which PyPI has as `bpy`. The Python must not have the package discrete_fairing itself.
"""

import os
import runpy
import sys
import tempfile
from pathlib import Path

zip_file = Path(sys.argv[1]).resolve()
script = Path(sys.argv[2] if sys.argv[2:] else Path(__file__).with_name("headless_smoke.py"))
os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp()  # Blender reads it when it is imported

import bpy  # noqa: E402

given = {"repo": "user_default", "filepath": str(zip_file), "enable_on_install": True}
bpy.ops.extensions.package_install_files(**given)

import discrete_fairing  # noqa: E402

print(f"Blender {bpy.app.version_string}: {discrete_fairing._native.__file__}", flush=True)
runpy.run_path(str(script.resolve()), run_name="__main__")
