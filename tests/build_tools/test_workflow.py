# SPDX-License-Identifier: GPL-3.0-or-later
"""GitHub's workflow and cibuildwheel, which build wheels on machines of their own kind and have never run here."""

import re
import subprocess
import sys

import pytest
import yaml
from cross.targets import TARGETS
from layout import ROOT

WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
CHECKS = ROOT / ".github" / "workflows" / "checks.yml"
# GitHub's names of machines, by what Blender calls the platform
MACHINES = {
    r"ubuntu-\d+\.\d+": "linux-x64",
    r"ubuntu-\d+\.\d+-arm": "linux-arm64",
    r"macos-\d+": "macos-arm64",
    r"macos-\d+-intel": "macos-x64",
    r"windows-\d+": "windows-x64",
}


def checked(path):
    """Exit code and words of a check against GitHub's schema, which the tool carries."""
    words = ["--builtin-schema", "vendor.github-workflows", path]
    done = subprocess.run(
        [sys.executable, "-m", "check_jsonschema", *words], capture_output=True, text=True
    )
    return done.returncode, done.stdout + done.stderr


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_is_as_github_wants_it(path):
    code, text = checked(path)
    assert code == 0, text


def test_there_is_a_machine_for_every_platform():
    machines = yaml.safe_load(CHECKS.read_text())["jobs"]["wheels"]["strategy"]["matrix"]["machine"]
    found = [
        name for m in machines for pattern, name in MACHINES.items() if re.fullmatch(pattern, m)
    ]
    assert sorted(found) == sorted(target.name for target in TARGETS)


def test_what_runs_is_dev_py():
    """Except to set up a bare container, and for GitHub's own program."""
    jobs = yaml.safe_load(CHECKS.read_text())["jobs"].values()
    lines = [step["run"] for job in jobs for step in job["steps"] if "run" in step]
    assert len(lines) > 4
    ours = r"(python3?|apt-get update && apt-get) (build_tools/dev.py|install) .*"
    assert [x for x in lines if not re.fullmatch(ours + "|gh release create .*", x)] == []
