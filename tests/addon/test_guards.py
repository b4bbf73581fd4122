# SPDX-License-Identifier: GPL-3.0-or-later
"""No code from text, no other programs, no network; files only where the command line needs them; layers kept apart."""

from pathlib import Path

import guards
import pytest

ROOT = Path(__file__).resolve().parents[2]
ADDON = ROOT / "addon"
BINDING = ROOT / "native" / "binding" / "discrete_fairing"

# What each file needs of the file system.
MAY_USE_FILES = {
    "addon/command_line/files.py",  # looks whether an input can be read, makes the output and its folder
    "addon/command_line/main.py",  # `os`, to keep Blender's messages out of the report on standard output
    "addon/command_line/places.py",  # paths, to see whether two are the same file
    "addon/settings/presets.py",  # the name of the folder that the shipped presets lie in
}

# All their numbers can be tested, and used, without Blender.
PURE_FOLDERS = ("carry", "request")
PURE_FILES = (
    "native.py",
    "check/messages.py",
    "command_line/places.py",
    "command_line/progress.py",
    "command_line/report.py",
    "inspection/colours.py",
    "inspection/convergence.py",
    "inspection/curvature.py",
    "inspection/measures.py",
    "live/inputs.py",
    "live/pace.py",
)

FILES = sorted([*ADDON.rglob("*.py"), *BINDING.rglob("*.py")])
IN_ADDON = [path for path in FILES if path.is_relative_to(ADDON)]


def named(path):
    return path.relative_to(ROOT).as_posix()


def pure_files():
    folders = [path for folder in PURE_FOLDERS for path in (ADDON / folder).rglob("*.py")]
    return [*folders, *(ADDON / name for name in PURE_FILES)]


@pytest.mark.parametrize("path", FILES, ids=named)
def test_nothing_dangerous(path):
    assert not guards.faults(path.read_text(encoding="utf-8"), allow_files=named(path) in MAY_USE_FILES)


def test_whoever_may_use_files_does():
    for name in MAY_USE_FILES & {named(path) for path in FILES}:
        assert guards.faults((ROOT / name).read_text(encoding="utf-8")), f"{name} needs no exception any more"


@pytest.mark.parametrize("path", IN_ADDON, ids=named)
def test_own_modules_are_imported_relatively(path):
    outside = guards.outside_imports(path.read_text(encoding="utf-8"))
    core = {"discrete_fairing"} if path == ADDON / "native.py" else set()
    assert {name for name in outside if not guards.is_allowed_outside(name)} == core


@pytest.mark.parametrize("path", pure_files(), ids=named)
def test_no_blender_where_numbers_are_made(path):
    assert not guards.outside_imports(path.read_text(encoding="utf-8")) & guards.BLENDER


@pytest.mark.parametrize("path", sorted(BINDING.rglob("*.py")), ids=named)
def test_the_core_knows_nothing_of_blender(path):
    outside = guards.outside_imports(path.read_text(encoding="utf-8"))
    assert all(guards.is_allowed_outside(name) for name in outside) and not outside & guards.BLENDER


@pytest.mark.parametrize(
    "snippet",
    [
        "eval('1')",
        "def f():\n    exec(text)",
        "run = eval",
        "compile('1', '', 'eval')",
        "__import__('os')",
        "__builtins__['eval']",
        "import builtins\nbuiltins.exec('1')",
        "import pickle",
        "import pickle as p",
        "from marshal import loads",
        "import shelve",
        "import subprocess",
        "def f():\n    import subprocess",
        "import socket",
        "import urllib.request",
        "from urllib import request",
        "import http.client",
        "import requests",
        "import ctypes",
        "import importlib",
        "os.system('ls')",
        "os.execv('ls', [])",
        "os.spawnl(0, 'ls')",
        "from os import system",
        "open('x')",
        "Path('x').write_text('')",
        "path.unlink()",
        "np.save('x', a)",
        "import shutil",
        "import tempfile",
    ],
)
def test_the_guard_sees(snippet):
    assert guards.faults(snippet)


@pytest.mark.parametrize(
    "snippet", ["import os\nos.system('ls')", "eval('1')", "import pickle", "import socket"]
)
def test_the_guard_sees_where_files_are_allowed(snippet):
    assert guards.faults(snippet, allow_files=True)


@pytest.mark.parametrize(
    "snippet",
    [
        "import numpy as np\nnp.empty(3)",
        "from ..run import job",
        "re.compile('x')",
        "import json\njson.loads('1')",
        "evaluated = 1",
        "bpy.ops.wm.obj_import(filepath='x')",
    ],
)
def test_the_guard_lets_through(snippet):
    assert not guards.faults(snippet)


def test_the_guard_knows_who_is_outside():
    text = "import addon.native\nfrom addon import run\nimport scipy\nfrom . import x\nfrom discrete_fairing import fair\nimport json"
    outside = guards.outside_imports(text)
    assert {name for name in outside if not guards.is_allowed_outside(name)} == {
        "addon",
        "scipy",
        "discrete_fairing",
    }
