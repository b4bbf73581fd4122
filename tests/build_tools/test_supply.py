# SPDX-License-Identifier: GPL-3.0-or-later
"""All that comes from outside is known: versions are exact, and files have known hashes."""

import re

import pytest
import python_environment
import yaml
from layout import ROOT

TOOLS = ROOT / "build_tools"
LISTS = sorted(path for path in TOOLS.glob("requirements*.txt"))
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
PINNED = re.compile(r"^([\w.-]+)==([\w.]+)")


def pins(text):
    """(name, version) of each line that has them."""
    found = [PINNED.match(line) for line in text.splitlines()]
    return {(re.sub(r"[-_.]+", "-", m[1]).lower(), m[2]) for m in found if m}


@pytest.mark.parametrize("path", LISTS, ids=lambda path: path.stem)
def test_every_package_has_its_hashes(path):
    lock = path.with_suffix(".lock").read_text()
    wanted = pins(path.read_text())
    assert wanted and wanted <= pins(lock)
    entries = re.split(r"\n(?=\w)", lock.split("\n", 2)[2])
    assert len(entries) == len(pins(lock))
    for entry in entries:
        assert re.search(r"--hash=sha256:[0-9a-f]{64}\b", entry), entry


def test_the_environment_has_nothing_else():
    path = TOOLS / "requirements.txt"
    assert pins(path.read_text()) == pins(path.with_suffix(".lock").read_text())


@pytest.mark.parametrize("name", ["install", "install_rivals"])
def test_packages_without_their_hash_are_refused(name, monkeypatch, tmp_path):
    commands = []
    for of in ("run", "leave", "say"):
        monkeypatch.setattr(python_environment, of, lambda *_: None)
    monkeypatch.setattr(python_environment, "is_fresh", lambda *_: False)
    monkeypatch.setattr(python_environment, "fingerprint", lambda *_: "")
    monkeypatch.setattr(python_environment, "pip", lambda *words: commands.append(words))
    getattr(python_environment, name)()
    (words,) = commands
    assert "--require-hashes" in words and words[-1].suffix == ".lock"


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_names_commits_and_hashes(path):
    steps = [s for job in yaml.safe_load(path.read_text())["jobs"].values() for s in job["steps"]]
    for step in steps:
        if "uses" in step:
            assert re.fullmatch(r"[\w/-]+@[0-9a-f]{40}", step["uses"]), step
        assert "pip install" not in step.get("run", ""), step


def test_cibuildwheel_installs_nothing_without_hashes():
    text = (ROOT / "pyproject.toml").read_text()
    found = re.findall(r"pip install.*", text)
    assert found and all("--require-hashes" in line for line in found)


def test_source_archives_have_their_hash():
    text = (ROOT / "cmake" / "dependencies.cmake").read_text()
    archives = re.findall(r"^  URL .*\n(.*)", text, re.MULTILINE)
    assert len(archives) == 3
    for following in archives:
        assert re.fullmatch(r"  URL_HASH SHA256=[0-9a-f]{64}", following)
