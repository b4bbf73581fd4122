# SPDX-License-Identifier: GPL-3.0-or-later
"""The suites for other machines, with a program in the emulator's place that writes a report and no more."""

from types import SimpleNamespace

import pytest
import suites
from cross import arm_suite, surfaces, windows_suite
from shell import DevError
from tally import Tally

REPORT = '<testsuites><testcase name="a"/><testcase name="b"><failure/></testcase></testsuites>'


def emulator(report):
    """A run that leaves a report with one test that passed and one that failed."""

    def run(*_words, **_options):
        report.write_text(REPORT)
        return 1

    return run


@pytest.fixture
def program(tmp_path):
    """In place of the native tests' program."""
    path = tmp_path / "build" / "fairing_tests.exe"
    path.parent.mkdir()
    path.write_bytes(b"MZ")
    return path


@pytest.mark.parametrize("old", [False, True])
def test_windows_native_suite_reads_the_report_of_this_run(program, tmp_path, monkeypatch, old):
    report = tmp_path / "native.xml"
    if old:
        report.write_text("<testsuites/>")
    root = SimpleNamespace(outside=tmp_path, command=lambda *words, **extra: list(words))
    monkeypatch.setattr(windows_suite, "WINE", root)
    monkeypatch.setattr(windows_suite.native_build, "program", lambda target, name: program)
    monkeypatch.setattr(windows_suite, "run", emulator(report))
    assert windows_suite.native() == Tally(passed=1, failed=1)


def test_arm_native_suite_reads_the_report_of_this_run(program, tmp_path, monkeypatch):
    report = tmp_path / "native.xml"
    monkeypatch.setattr(arm_suite, "fresh_report", lambda name: report)
    monkeypatch.setattr(arm_suite.native_build, "program", lambda target, name: program)
    monkeypatch.setattr(arm_suite, "run", emulator(report))
    assert arm_suite.native() == Tally(passed=1, failed=1)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("60 passed, 0 failed\n", Tally(passed=60)),
        ("differs by 1e-3: a\n58 passed, 2 failed\n", Tally(passed=58, failed=2)),
        ("terminate called\n", Tally(failed=1, note="the surfaces were not compared")),
    ],
)
def test_tally_of_surfaces(text, found):
    assert surfaces.tally(text) == found


def test_parts_of_other_suites_are_refused():
    with pytest.raises(DevError, match="part"):
        suites.suite_named("native:stencil")()
