# SPDX-License-Identifier: GPL-3.0-or-later
"""No code from text, no programs, no network; files only where needed; rooms kept apart."""

from graphlib import TopologicalSorter
from pathlib import Path

import guards
import pytest

ROOT = Path(__file__).resolve().parents[2]
ADDON = ROOT / "addon"
BINDING = ROOT / "native" / "binding" / "discrete_fairing"

# What each file needs of the file system.
MAY_USE_FILES = {
    "addon/cli/ease.py",  # paths of tables, which files.py writes
    "addon/cli/engines.py",  # `os` and the folder that the command was called in
    "addon/cli/files.py",  # looks whether an input can be read, makes the output and its folder
    "addon/cli/main.py",  # `os`, to keep Blender's messages out of the report on standard output
    "addon/cli/places.py",  # paths, to see whether two are the same file, and patterns of them
    "addon/cli/materials.py",  # `os`, to see whether a name is taken
    "addon/cli/whole.py",  # reads an output, to see whether it is complete
    "addon/purposes.py",  # the names of the shipped presets and their pictures
    "addon/ui/pictures.py",  # where they lie
    "addon/operators/strain.py",  # writes its table through whole_files.py
    "addon/queue.py",  # `os`, for the priority of threads
    "native/binding/discrete_fairing/whole_files.py",  # writes a file beside its place first
    "native/binding/discrete_fairing/step.py",  # opens the one that it is given there
    "native/binding/discrete_fairing/piecewise/files.py",  # pieces and parts, without pickles
    "native/binding/discrete_fairing/piecewise/part.py",  # the same, rounded
    "native/binding/discrete_fairing/piecewise/joining.py",  # reads a part at a time
}

# Starts this command again for a share of the inputs, and hands pieces to other processes.
MAY_START_PROCESSES = {"addon/cli/engines.py"}

# Packages of the extra "cluster", asked for where they are needed: what cuts meshes, what holds pieces.
OF_CLUSTERS = {"partition.py": {"pymetis"}, "files.py": {"zarr"}, "engines.py": {"distributed"}}

# All their numbers can be tested, and used, without Blender.
PURE_FOLDERS = ("curves", "transfer")
PURE_FILES = (
    "choices.py",
    "core.py",
    "errors.py",
    "measured.py",
    "poll.py",
    "purposes.py",
    "queue.py",
    "size.py",
    "cad/words.py",
    "cli/places.py",
    "cli/report.py",
    "inspection/curvature.py",
    "inspection/drawn.py",
    "inspection/measures.py",
    "inspection/sections.py",
    "inspection/stripes.py",
    "live/pace.py",
    "strain/drawn.py",
    "strain/strained.py",
    "strain/table.py",
    "strain/words.py",
    "units.py",
)

# The rooms from the lowest to the highest: each imports from those before it, never from those
# behind.
ROOMS = (
    {"blender", "choices", "core", "poll", "purposes", "redraw", "size", "units"},
    {"errors", "prediction", "preferences", "queue", "settings", "transfer", "vertex_values"},
    {"curves"},
    {"records"},
    {"memory"},
    {"mesh"},
    {"curve_cage", "place"},
    {"check", "freshness", "inspection", "measured"},
    {"cleaning", "in_place", "holes", "job"},
    {"live"},
    {"cad", "strain"},
    {"cli", "ui"},
    {"operators"},
    {"__init__"},
)
RANK = {room: rank for rank, rooms in enumerate(ROOMS) for room in rooms}

FILES = sorted([*ADDON.rglob("*.py"), *BINDING.rglob("*.py")])
IN_ADDON = [path for path in FILES if path.is_relative_to(ADDON)]


def named(path):
    return path.relative_to(ROOT).as_posix()


def module_of(path):
    """("mesh", "read") for addon/mesh/read.py, ("cli", "__init__") for addon/cli/__init__.py."""
    return path.relative_to(ADDON).with_suffix("").parts


def pure_files():
    folders = [path for folder in PURE_FOLDERS for path in (ADDON / folder).rglob("*.py")]
    return [*folders, *(ADDON / name for name in PURE_FILES)]


@pytest.mark.parametrize("path", FILES, ids=named)
def test_nothing_dangerous(path):
    assert not guards.faults(
        path.read_text(encoding="utf-8"),
        allow_files=named(path) in MAY_USE_FILES,
        allow_processes=named(path) in MAY_START_PROCESSES,
    )


def test_whoever_may_use_files_does():
    for name in MAY_USE_FILES & {named(path) for path in FILES}:
        assert guards.faults((ROOT / name).read_text(encoding="utf-8")), (
            f"{name} needs no exception any more"
        )


@pytest.mark.parametrize("path", IN_ADDON, ids=named)
def test_own_modules_are_imported_relatively(path):
    outside = guards.outside_imports(path.read_text(encoding="utf-8"))
    core = {"discrete_fairing"} if path == ADDON / "core.py" else set()
    core |= OF_CLUSTERS.get(path.name, set()) & outside
    assert {name for name in outside if not guards.is_allowed_outside(name)} == core


@pytest.mark.parametrize("path", IN_ADDON, ids=named)
def test_imports_point_one_way(path):
    own = module_of(path)
    for other in guards.own_imports(path.read_text(encoding="utf-8"), own):
        same_room = other[0] == own[0]
        assert same_room or RANK[other[0]] <= RANK[own[0]], ".".join(other)


def test_no_module_imports_itself_through_others():
    """Between rooms of one rank, and within a room."""
    graph = {
        module_of(path): guards.own_imports(path.read_text(encoding="utf-8"), module_of(path))
        for path in IN_ADDON
        if "presets" not in path.parts
    }
    TopologicalSorter(graph).prepare()  # raises CycleError


@pytest.mark.parametrize("path", pure_files(), ids=named)
def test_no_blender_where_numbers_are_made(path):
    assert not guards.outside_imports(path.read_text(encoding="utf-8")) & guards.BLENDER


@pytest.mark.parametrize("path", sorted(BINDING.rglob("*.py")), ids=named)
def test_the_core_knows_nothing_of_blender(path):
    outside = guards.outside_imports(path.read_text(encoding="utf-8"))
    outside -= OF_CLUSTERS.get(path.name, set())
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


def test_the_guard_sees_where_processes_are_allowed():
    for snippet in ("eval('1')", "import pickle", "import socket", "import importlib"):
        assert guards.faults(snippet, allow_files=True, allow_processes=True)
    assert not guards.faults("import subprocess", allow_processes=True)


@pytest.mark.parametrize(
    "snippet",
    [
        "import numpy as np\nnp.empty(3)",
        "from ..mesh import read",
        "re.compile('x')",
        "import json\njson.loads('1')",
        "evaluated = 1",
        "bpy.ops.wm.obj_import(filepath='x')",
    ],
)
def test_the_guard_lets_through(snippet):
    assert not guards.faults(snippet)


def test_the_guard_knows_who_is_outside():
    text = "import addon.core\nfrom addon import job\nimport scipy\nfrom . import x\nfrom discrete_fairing import fair\nimport json"
    outside = guards.outside_imports(text)
    assert {name for name in outside if not guards.is_allowed_outside(name)} == {
        "addon",
        "scipy",
        "discrete_fairing",
    }


def test_the_guard_resolves_own_imports():
    text = "from . import a, b\nfrom .c import d\nfrom ..core import load\nfrom .. import size\nimport json"
    assert guards.own_imports(text, ("mesh", "read")) == {
        ("mesh", "a"),
        ("mesh", "b"),
        ("mesh", "c"),
        ("core",),
        ("size",),
    }
    text = "if TYPE_CHECKING:\n    from .session import Session\nelse:\n    from .pace import Pace"
    assert guards.own_imports(text, ("live", "registry")) == {("live", "pace")}
    assert guards.own_imports("from .mesh.read import x\nfrom .mesh import y", ("job",)) == {
        ("mesh", "read"),
        ("mesh", "y"),
    }
