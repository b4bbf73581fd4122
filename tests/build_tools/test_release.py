# SPDX-License-Identifier: GPL-3.0-or-later
"""What a release is made of, without compiling: zips of settled bytes, notes, sums."""

import subprocess
import zipfile

import pytest
import release
from shell import DevError


def packed(path, names):
    with zipfile.ZipFile(path, "w") as archive:
        for name in names:
            archive.writestr(name, name)
    return path


def test_settled_zips_are_the_same_in_any_order(tmp_path):
    one = packed(tmp_path / "one.zip", ["b.py", "a/", "a/c.py"])
    other = packed(tmp_path / "other.zip", ["a/", "a/c.py", "b.py"])
    for path in (one, other):
        release.settle(path, 1_700_000_000)
    assert one.read_bytes() == other.read_bytes()
    with zipfile.ZipFile(one) as archive:
        assert archive.namelist() == ["a/", "a/c.py", "b.py"]
        assert archive.read("a/c.py") == b"a/c.py"


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
