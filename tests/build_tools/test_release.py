# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a release, without compiling: zips, page, components, notes, sums."""

import json
import re
import subprocess
import zipfile

import components
import pytest
import release
from layout import ROOT
from release_suite import newer, next_version
from shell import DevError
from wheel_version import manifest_version

EPOCH = 1_700_000_000  # seconds since 1970


def test_the_next_version_differs_by_its_manifest_alone(tmp_path):
    old = manifest_version()
    path = tmp_path / f"discrete_fairing-{old}-linux_x64.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("a.py", "a")
        archive.writestr("blender_manifest.toml", f'id = "x"\nversion = "{old}"\n')
    with zipfile.ZipFile(newer(path)) as archive:
        assert archive.read("a.py") == b"a"
        manifest = archive.read("blender_manifest.toml").decode()
    assert manifest == f'id = "x"\nversion = "{next_version(old)}"\n'


def test_components_are_those_whose_licences_we_give():
    listed = json.loads(components.listing(manifest_version(), EPOCH))
    text = (ROOT / "THIRD_PARTY_LICENSES.txt").read_text("utf-8")
    named = re.findall(r"^(\w.*) \((https://\S+)\), ", text, re.MULTILINE)
    found = [(c["name"], c["externalReferences"][0]["url"]) for c in listed["components"]]
    assert len(named) > 4
    assert sorted(found) == sorted(named)
    assert listed["specVersion"] == "1.6"
    assert listed["metadata"]["component"]["version"] == manifest_version()


def test_notes_are_the_newest_section_alone():
    text = "# Changes\n\n## [2.0]\n\n### Added\n\n- new\n\n## [1.0]\n\n- old\n"
    assert release.notes(text) == "### Added\n\n- new\n"


def test_a_changelog_without_sections_is_refused():
    with pytest.raises(DevError, match="no section"):
        release.notes("# Changes\n")


def test_sums_are_what_sha256sum_checks(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a").write_bytes(b"a")
    (tmp_path / release.SUMS).write_text(release.sums(tmp_path))
    command = ["sha256sum", "--check", "--strict", release.SUMS]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True).returncode == 0
    (tmp_path / "in" / "a").write_bytes(b"b")
    assert subprocess.run(command, cwd=tmp_path, capture_output=True).returncode != 0
