# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents are true: their links, names, explained settings and examples."""

import inspect
import re
from functools import cache
from pathlib import Path

import bpy
import discrete_fairing as df
import numpy as np
import pytest
from discrete_fairing.options import OPTIONAL, SETTINGS

from addon.preferences import DiscreteFairingPreferences
from addon.properties import FairingSettings

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
DOCUMENTS = [
    *(ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING", "CHANGELOG")),
    *sorted(path for path in DOCS.rglob("*.md") if path.parent.name != "site"),
    ROOT / "benchmarks" / "results" / "README.md",
]
# Whose Python runs in Blender, and the files that it leaves.
PYTHON = {
    "how-to/scripting.md": ["faired.blend"],
    "trades/hull.md": [],
    "trades/panel.md": [],
    "trades/scan.md": [],
    "trades/cad.md": ["cube.step"],
    "python/fair.md": [],
    "python/solver.md": [],
    "python/holes.md": [],
    "python/strain.md": [],
    "../README.md": [],
}

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
OPERATOR = re.compile(r"\b(?:bpy\.ops\.)?(object|mesh|view3d)\.(fair(?:ing)?_\w+)")
ANY_OPERATOR = re.compile(r"\bbpy\.ops\.(\w+)\.(\w+)")


def named(path):
    return path.relative_to(ROOT).as_posix()


def code_blocks(text, language):
    return [body for kind, body in FENCE.findall(text) if kind == language]


def prose(text):
    """The text without code, whose brackets are no links and whose hashes are no headings."""
    return FENCE.sub("", text)


def anchor(heading):
    """What GitHub makes of a heading."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


@cache
def anchors(path):
    return {
        anchor(line)
        for line in re.findall(r"^#+ (.+)$", prose(path.read_text("utf-8")), re.MULTILINE)
    }


def broken_links(text, folder, own):
    """Relative links in `text`, of the document `own` in `folder`, that lead nowhere."""
    found = []
    for link in LINK.findall(prose(text)):
        if re.match(r"[a-z]+:", link):
            continue
        target, _, part = link.partition("#")
        path = (folder / target).resolve() if target else own
        if not path.exists() or (part and part not in anchors(path)):
            found.append(link)
    return found


def wrong(judge):
    """The faults that `judge` finds, by document, from its text and path."""
    found = {named(path): judge(path.read_text("utf-8"), path) for path in DOCUMENTS}
    return {name: faults for name, faults in found.items() if faults}


def test_links_lead_somewhere():
    assert wrong(lambda text, path: broken_links(text, path.parent, path)) == {}


def test_operators_exist():
    def unknown(text, _):
        named = {*OPERATOR.findall(text), *ANY_OPERATOR.findall(text)}
        return [
            (module, name) for module, name in named if name not in dir(getattr(bpy.ops, module))
        ]

    assert wrong(unknown) == {}


def settings_page():
    return (DOCS / "reference" / "settings.md").read_text("utf-8")


def is_said(words):
    """Whether the page of settings has these words as whole words."""
    return re.search(rf"(?<![\w-]){re.escape(words)}(?![\w-])", settings_page()) is not None


def test_settings_are_explained_with_their_defaults():
    found = re.findall(r"`(\w+)`(?: \([\w ]+\))?, (on|off|[\d.]+)(?=°|,|;|$| |\n)", settings_page())
    stated, checked = dict(found), 0
    for name, property in FairingSettings.__annotations__.items():
        words = property.keywords
        assert f"`{name}`" in settings_page() and is_said(words["name"]), name
        for key, label, *_ in words.get("items", ()):
            assert is_said(label) and is_said(key), f"{name}: {label}"
        if name in stated:
            default = words["default"]
            if isinstance(default, bool):
                assert default == (stated[name] == "on"), name
            else:
                scale = 180 / np.pi if words.get("subtype") == "ANGLE" else 1
                assert scale * default == pytest.approx(float(stated[name])), name
            checked += 1
    for name, property in DiscreteFairingPreferences.__annotations__.items():
        cells = (property.keywords["name"], f"`{name}`", property.keywords["default"])
        assert "| {} | {} | {} |".format(*cells) in settings_page().replace("`{}`", "{}"), name
    assert checked > 15


def default_argument(name):
    """The default of an argument of fair(); None if it has none."""
    if name in SETTINGS:
        core = getattr(df._native.Options(), name)
        plain = core[0] if isinstance(core, list) and core else core
        return None if name in OPTIONAL else getattr(plain, "name", plain)
    default = inspect.signature(df.fair).parameters[name].default
    return None if default is inspect.Parameter.empty else default


def test_arguments_of_the_core_are_explained_with_their_defaults():
    tables = (DOCS / "python" / "fair.md").read_text("utf-8").partition("\n### Energy")[0]
    told = dict(re.findall(r"^\| `(\w+)`[^|]*\| `?([^|`]*)`? \|", tables, re.MULTILINE))
    for name in {*inspect.signature(df.fair).parameters, *SETTINGS} - {"settings"}:
        assert len(re.findall(rf"^\| [^|]*`{name}`", tables, re.MULTILINE)) == 1, name
        if name in told:
            default, said = default_argument(name), told[name].strip().strip('"')
            if said in ("", "none"):
                assert default is None, name
            elif isinstance(default, bool | str) or default is None:
                assert str(default) == said, name
            else:
                assert float(default) == float(said), name
    assert len(told) > 30
    pages = "".join(page.read_text("utf-8") for page in (DOCS / "python").glob("*.md"))
    assert [n for n in df.__all__ if not re.search(rf"\b{n}\b", pages)] == []


@pytest.mark.parametrize(("name", "left"), PYTHON.items())
def test_examples_run(name, left, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PWD", str(tmp_path))  # by which Blender finds relative paths
    namespace = {}
    blocks = code_blocks((DOCS / name).read_text("utf-8"), "python")
    assert blocks
    for number, block in enumerate(blocks, 1):
        exec(compile(block, f"{name}, example {number}", "exec"), namespace)
    assert [path.name for path in tmp_path.iterdir()] == left
