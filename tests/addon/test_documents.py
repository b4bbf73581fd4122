# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents keep what they say: links, names, explained settings, examples that run."""

import inspect
import re
from functools import cache
from pathlib import Path

import bpy
import discrete_fairing
import pytest

from addon.preferences import DiscreteFairingPreferences
from addon.settings import FairingSettings

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
DOCUMENTS = [
    *(ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING", "CHANGELOG")),
    *sorted(DOCS.glob("*.md")),
]
PICTURES = DOCS / "images" / "settings"
PYTHON = ("scripting.md",)  # whose Python runs in Blender; the NumPy API's runs without it

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
OPERATOR = re.compile(r"\b(?:bpy\.ops\.)?(object|mesh|view3d)\.(fair(?:ing)?_\w+)")
ANY_OPERATOR = re.compile(r"\bbpy\.ops\.(\w+)\.(\w+)")
# A source file as documents name it: from the top, or from the folder that they are about.
SOURCE = re.compile(r"`((?!out/)[\w./-]+/[\w.-]+\.(?:cpp|h|py|sh|toml|json))`")
PLACES = ("", "native/", "addon/", "tests/")
MACHINE = re.compile(
    r"(?<![\w.])/(?:work|home|root|Users|tmp|usr|opt|mnt|media|var)/|\bfile://|\b[A-Z]:\\",
    re.IGNORECASE,
)


def named(path):
    return path.relative_to(ROOT).as_posix()


def code_blocks(text, language):
    return [body for kind, body in FENCE.findall(text) if kind == language]


def prose(text):
    """The text without its code, whose brackets are no links and whose hashes are no headings."""
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


def operators(text):
    """(module, name) of all operators that `text` names, ours and Blender's."""
    return {*OPERATOR.findall(text), *ANY_OPERATOR.findall(text)}


def missing_sources(text):
    """Files that `text` names and that are not there."""
    return [
        name
        for name in SOURCE.findall(text)
        if not any((ROOT / place / name).exists() for place in PLACES)
    ]


def exists(module, name):
    return name in dir(getattr(bpy.ops, module))


def setting_names():
    """Property and name in the interface of every setting and preference."""
    for owner in (FairingSettings, DiscreteFairingPreferences):
        for name, declared in owner.__annotations__.items():
            yield name, declared.keywords["name"]


def is_said(words, text):
    """Whether `words` stand in `text` as whole words."""
    return re.search(rf"(?<![\w-]){re.escape(words)}(?![\w-])", text) is not None


@pytest.mark.parametrize("path", DOCUMENTS, ids=named)
def test_links_lead_somewhere(path):
    assert broken_links(path.read_text("utf-8"), path.parent, path) == []


@pytest.mark.parametrize("path", DOCUMENTS, ids=named)
def test_operators_exist(path):
    assert {pair for pair in operators(path.read_text("utf-8")) if not exists(*pair)} == set()


@pytest.mark.parametrize("path", DOCUMENTS, ids=named)
def test_sources_are_there(path):
    assert missing_sources(path.read_text("utf-8")) == []


@pytest.mark.parametrize("path", DOCUMENTS, ids=named)
def test_nothing_of_one_machine(path):
    assert MACHINE.findall(path.read_text("utf-8")) == []


@pytest.mark.parametrize(("name", "label"), list(setting_names()))
def test_every_setting_is_explained(name, label):
    text = (DOCS / "settings.md").read_text("utf-8")
    assert f"`{name}`" in text, "its property"
    assert is_said(label, text), "its name in Blender"


def test_every_choice_is_explained():
    text = (DOCS / "settings.md").read_text("utf-8")
    for name, declared in FairingSettings.__annotations__.items():
        for key, label, *_ in declared.keywords.get("items", ()):
            assert is_said(label, text) and f"`{key}`" in text, f"{name}: {label}"


@pytest.mark.parametrize("name", list(inspect.signature(discrete_fairing.fair).parameters))
def test_every_argument_of_the_core_is_explained_once(name):
    tables = (DOCS / "numpy-api.md").read_text("utf-8").partition("\n### Energy")[0]
    assert len(re.findall(rf"^\| [^|]*`{name}`", tables, re.MULTILINE)) == 1


@pytest.mark.parametrize("path", sorted(PICTURES.glob("*.png")), ids=named)
def test_pictures_are_small_and_used(path):
    assert path.stat().st_size <= 150_000
    link = path.relative_to(DOCS).as_posix()
    assert any(link in document.read_text("utf-8") for document in DOCUMENTS)


@pytest.mark.parametrize("name", PYTHON)
def test_examples_run(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PWD", str(tmp_path))  # by which Blender finds relative paths
    namespace = {}
    blocks = code_blocks((DOCS / name).read_text("utf-8"), "python")
    assert blocks
    for number, block in enumerate(blocks, 1):
        exec(compile(block, f"{name}, example {number}", "exec"), namespace)
    assert [path.name for path in tmp_path.iterdir()] == ["faired.blend"]


@pytest.mark.parametrize(
    "text",
    ["[x](nowhere.md)", "![x](images/nowhere.png)", "[x](settings.md#nowhere)", "[x](#nowhere)"],
)
def test_a_broken_link_is_seen(text):
    assert broken_links(text, DOCS, DOCS / "guide.md")


def test_a_good_link_is_let_through():
    text = "[a](settings.md#levels) [b](https://example.org/) [c](../README.md)\n```python\nx[0](nowhere)\n```"
    assert broken_links(text, DOCS, DOCS / "guide.md") == []


@pytest.mark.parametrize(
    "text", ["`object.fair_everything`", "bpy.ops.object.nowhere()", "bpy.ops.object.fairing_x"]
)
def test_an_operator_that_does_not_exist_is_seen(text):
    assert [pair for pair in operators(text) if not exists(*pair)]


@pytest.mark.parametrize(
    "text", ["see /home/someone/x", "`/work/main`", "C:\\Users\\x", "file:///tmp/x"]
)
def test_a_machine_path_is_seen(text):
    assert MACHINE.search(text)


def test_a_missing_source_is_seen():
    assert missing_sources("`native/nowhere.h` and `hold/nowhere.cpp`") == [
        "native/nowhere.h",
        "hold/nowhere.cpp",
    ]
    assert missing_sources("`hold/pads.h`, `addon/core.py`, `out/bench/NAME.json`, `a.h`") == []


def test_a_setting_is_not_said_by_a_longer_name():
    assert not is_said("Levels", "Default-Levels, Levels2")
