# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's own Python in .venv, with every dependency at an exact version, and Pythons for single tools."""

import shutil
import sys
from pathlib import Path

from layout import CACHE, ROOT, VENV, VENV_PYTHON
from shell import DevError, output, run, say
from stamp import fingerprint, is_fresh, leave

REQUIREMENTS = ROOT / "build_tools" / "requirements.lock"  # locked versions of requirements.txt
STAMP = VENV / "stamps" / "requirements"
RIVALS = ROOT / "build_tools" / "requirements_bench.lock"
RIVALS_STAMP = VENV / "stamps" / "requirements_bench"
BPY_VERSION = (3, 11)  # Blender 4.1 to 5.0, hence of the bpy wheel


def has_bpy() -> bool:
    """Whether .venv has the bpy module, which exists for one version of Python only."""
    return (VENV / "lib" / "python{}.{}".format(*BPY_VERSION) / "site-packages" / "bpy").is_dir()


def base_python() -> str:
    """The Python for .venv: the version that bpy needs, if there is one."""
    if sys.version_info[:2] == BPY_VERSION:
        return sys.executable
    name = "python{}.{}".format(*BPY_VERSION)
    return shutil.which(name) or sys.executable


def install() -> None:
    """Makes .venv and installs missing packages; returns at once if the requirements have not changed."""
    base = base_python()
    version = output(base, "-VV")[1]
    value = fingerprint([REQUIREMENTS], version)
    if is_fresh(STAMP, value) and VENV_PYTHON.exists():
        return
    say(f"Python environment: {VENV.relative_to(ROOT)}, {version.split(' (')[0].strip()}")
    if output(VENV_PYTHON, "-VV")[1] != version:
        run(base, "-m", "venv", "--clear", VENV)
    pip("install", "--require-hashes", "--requirement", REQUIREMENTS)
    leave(STAMP, value)
    if not has_bpy():
        say("bpy exists for Python 3.11 only: here the add-on is tested in the real Blender alone.")


def install_rivals() -> None:
    """Installs the programs that benchmarks compare with; without dependencies, since bpy needs its NumPy."""
    value = fingerprint([RIVALS], STAMP.read_text())
    if not is_fresh(RIVALS_STAMP, value):
        pip("install", "--no-deps", "--require-hashes", "--requirement", RIVALS)
        leave(RIVALS_STAMP, value)


def install_tool(name: str, lock: Path) -> Path:
    """A Python in the cache with a tool's packages, which are not in .venv but can import its packages."""
    folder = CACHE / name
    python, stamp = folder / "bin" / "python", folder / "stamp"
    value = fingerprint([lock], STAMP.read_text(), str(VENV))
    if not is_fresh(stamp, value):
        say(f"Python environment: {folder.relative_to(ROOT)}")
        run(VENV_PYTHON, "-m", "venv", "--clear", folder)
        pip("install", "--require-hashes", "--requirement", lock, python=python)
        (packages,) = folder.glob("lib/python*/site-packages")
        (shared,) = VENV.glob("lib/python*/site-packages")
        # a path file appends: the tool's own packages come first
        (packages / "shared.pth").write_text(f"{shared}\n")
        leave(stamp, value)
    return python


def pybind11() -> str:
    """The folder with pybind11's CMake files."""
    code, folder = output(VENV_PYTHON, "-m", "pybind11", "--cmakedir")
    if code:
        raise DevError("pybind11 is not in .venv: run `dev.py setup` first.")
    return folder.strip()


def pip(*arguments: str | Path, python: Path = VENV_PYTHON, **extra: str) -> None:
    """Runs pip, in .venv by default."""
    run(python, "-m", "pip", "--quiet", "--disable-pip-version-check", *arguments, **extra)
