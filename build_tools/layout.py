# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of the project's folders, and of those that dev.py makes."""

from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ADDON = ROOT / "addon"
MANIFEST = ROOT / "blender_manifest.toml"

BUILD = ROOT / "build"
CACHE = ROOT / ".cache"
OUT = ROOT / "out"
VENV = ROOT / ".venv"
VENV_BIN = VENV / "bin"
VENV_PYTHON = VENV_BIN / "python"
