# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents keep what they say: links, names, explained settings, examples that run."""

import inspect
import re
from functools import cache
from pathlib import Path

import bpy
import discrete_fairing
import pytest
from discrete_fairing.options import SETTINGS

from addon.preferences import DiscreteFairingPreferences
from addon.properties import FairingSettings

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
NOTES = "developers/notes"
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

NOT_FOR_USERS = ("developers", "site", "explanation/mathematics.md")
MOST_WORDS = 12_500  # 12,000 in November 2026; what comes in takes the place of something
TABLE = re.compile(r"<!-- table: .*?<!-- /table -->", re.DOTALL)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
OPERATOR = re.compile(r"\b(?:bpy\.ops\.)?(object|mesh|view3d)\.(fair(?:ing)?_\w+)")
ANY_OPERATOR = re.compile(r"\bbpy\.ops\.(\w+)\.(\w+)")
# A source file as documents name it: from the top, or from the folder that they are about.
SOURCE = re.compile(r"`((?!out/)[\w./-]+/[\w.-]+\.(?:cpp|h|py|sh|toml|json))`")
PLACES = ("", "native/", "addon/", "tests/")


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


def wrong(judge):
    """What `judge` finds in each document, of its text and its path; only where it finds something."""
    found = {named(path): judge(path.read_text("utf-8"), path) for path in DOCUMENTS}
    return {name: faults for name, faults in found.items() if faults}


def test_links_lead_somewhere():
    assert wrong(lambda text, path: broken_links(text, path.parent, path)) == {}


def test_operators_exist():
    assert wrong(lambda text, _: [pair for pair in operators(text) if not exists(*pair)]) == {}


def test_sources_are_there():
    assert wrong(lambda text, _: missing_sources(text)) == {}


@pytest.mark.parametrize(
    "folder", ["trades", "how-to", "python", "reference", "explanation", NOTES]
)
def test_every_page_is_listed(folder):
    contents = (DOCS / (f"{NOTES}/README.md" if folder == NOTES else "README.md")).read_text(
        "utf-8"
    )
    pages = {path.name for path in (DOCS / folder).glob("*.md")} - {"README.md"}
    prefix = "" if folder == NOTES else f"{folder}/"
    assert {name for name in pages if f"({prefix}{name}" not in contents} == set()


def test_every_setting_is_explained():
    text = (DOCS / "reference" / "settings.md").read_text("utf-8")
    for name, label in setting_names():
        assert f"`{name}`" in text, f"{name}: its property"
        assert is_said(label, text), f"{name}: its name in Blender"


def test_every_choice_is_explained():
    text = (DOCS / "reference" / "settings.md").read_text("utf-8")
    for name, declared in FairingSettings.__annotations__.items():
        for key, label, *_ in declared.keywords.get("items", ()):
            assert is_said(label, text) and f"`{key}`" in text, f"{name}: {label}"


def test_every_argument_of_the_core_is_explained_once():
    tables = (DOCS / "python" / "fair.md").read_text("utf-8").partition("\n### Energy")[0]
    by_place = set(inspect.signature(discrete_fairing.fair).parameters) - {"settings"}
    for name in by_place | set(SETTINGS):
        assert len(re.findall(rf"^\| [^|]*`{name}`", tables, re.MULTILINE)) == 1, name


def test_users_pages_are_short():
    """In all, without code, tables of figures and the mathematics."""
    pages = [
        page
        for page in DOCS.rglob("*.md")
        if not page.relative_to(DOCS).as_posix().startswith(NOT_FOR_USERS)
    ]
    text = "".join(TABLE.sub("", prose(p.read_text("utf-8"))) for p in pages)
    words = re.findall(r"[A-Za-z][A-Za-z'’-]*", re.sub(r"\]\([^)]*\)", "", text))
    assert len(words) <= MOST_WORDS


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
