# SPDX-License-Identifier: GPL-3.0-or-later
"""Pythons of their own for single tools, whose libraries stay out of .venv."""

from pathlib import Path

from layout import CACHE, ROOT, VENV
from python_environment import STAMP as PYTHON_STAMP
from shell import run, say
from stamp import fingerprint, is_fresh, leave


def lock_file(name: str) -> Path:
    """The tool's packages with their hashes."""
    return ROOT / "build_tools" / f"requirements_{name}.lock"


def install(name: str, tool: str) -> Path:
    """A Python in the cache with the packages of `requirements_{tool}.lock`; returns at once when it is as before.

    It finds the package and NumPy in .venv too.
    """
    folder, lock = CACHE / name, lock_file(tool)
    python, stamp = folder / "bin" / "python", folder / "stamp"
    value = fingerprint([lock], PYTHON_STAMP.read_text(), str(VENV))
    if not is_fresh(stamp, value):
        say(f"Python environment: {folder.relative_to(ROOT)}")
        run(VENV / "bin" / "python", "-m", "venv", "--clear", folder)
        quiet = ["install", "--quiet", "--disable-pip-version-check"]
        run(python, "-m", "pip", *quiet, "--require-hashes", "--requirement", lock)
        (packages,) = folder.glob("lib/python*/site-packages")
        (shared,) = VENV.glob("lib/python*/site-packages")
        # a path file adds to the end: what the tool brings along goes first
        (packages / "shared.pth").write_text(f"{shared}\n")
        leave(stamp, value)
    return python
