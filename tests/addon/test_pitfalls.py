# SPDX-License-Identifier: GPL-3.0-or-later
"""Pitfalls of Blender and Python that no test in this process meets: read from the source."""

import ast
from pathlib import Path

import pytest

pytestmark = pytest.mark.plain

ADDON = Path(__file__).resolve().parents[2] / "addon"


def trees():
    for path in sorted(ADDON.rglob("*.py")):
        yield path, ast.parse(path.read_text(encoding="utf-8"))


def test_annotations_are_asked_of_classes_alone():
    """Of an instance Python 3.14 has none."""
    asked = [
        f"{path.name}:{node.lineno}"
        for path, tree in trees()
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and node.attr == "__annotations__"
        and not (isinstance(node.value, ast.Name) and node.value.id.lstrip("_")[:1].isupper())
    ]
    assert asked == []


def test_what_begins_once_blender_has_started_begins_with_a_file_too():
    """A file that Blender opens at its start ends timers that are not persistent."""
    lost = []
    for path, tree in trees():
        handlers = "load_post" in path.read_text(encoding="utf-8")
        for function in ast.walk(tree):
            if not isinstance(function, ast.FunctionDef) or function.name != "register":
                continue
            for call in ast.walk(function):
                if isinstance(call, ast.Call) and ast.unparse(call.func).endswith(
                    "timers.register"
                ):
                    stays = any(word.arg == "persistent" for word in call.keywords)
                    if not stays and not handlers:
                        lost.append(path.name)
    assert lost == []
