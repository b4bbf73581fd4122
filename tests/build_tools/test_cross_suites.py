# SPDX-License-Identifier: GPL-3.0-or-later
"""The suites for other machines, with a program in the emulator's place that writes a report and no more."""

from pathlib import Path
from types import SimpleNamespace

import pytest
import suites
from cross import arm_suite, same_bits, windows_suite, wine, wine_complex
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
    monkeypatch.setattr(wine, "WINE", SimpleNamespace(outside=tmp_path, make=lambda: None))
    monkeypatch.setattr(wine, "command", lambda *words, **extra: list(words))
    monkeypatch.setattr(windows_suite.native_build, "tests", lambda target: program)
    monkeypatch.setattr(windows_suite, "run", emulator(report))
    assert windows_suite.native() == Tally(passed=1, failed=1)


def test_arm_native_suite_reads_the_report_of_this_run(program, tmp_path, monkeypatch):
    report = tmp_path / "native.xml"
    monkeypatch.setattr(arm_suite, "fresh_report", lambda name: report)
    monkeypatch.setattr(arm_suite.native_build, "tests", lambda target: program)
    monkeypatch.setattr(arm_suite, "run", emulator(report))
    assert arm_suite.native() == Tally(passed=1, failed=1)


def test_arm_programs_find_their_libraries_and_packages():
    words = list(map(str, arm_suite.python("script.py")))
    assert words[0] == "qemu-aarch64-static" and words[-1] == "script.py"
    given = dict(word.split("=", 1) for word in words if "=" in word)
    assert str(arm_suite.SITE) in given["PYTHONPATH"].split(":")
    assert Path(words[-2]).name == "python3.13"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("60 of 60 have the same bits\n", Tally(passed=60)),
        ("differs: a\n58 of 60 have the same bits\n", Tally(passed=58, failed=2)),
        ("Traceback\n", Tally(failed=1, note="the surfaces were not compared")),
    ],
)
def test_tally_of_surfaces(text, found):
    assert same_bits.tally(text) == found


@pytest.mark.parametrize(
    ("name", "run"),
    [
        ("windows", ["native", "cp311", "cp311 bits", "cp313", "cp313 bits"]),
        ("windows:cp313", ["cp313", "cp313 bits"]),
        ("windows:native", ["native"]),
    ],
)
def test_parts_of_the_suite_for_windows(monkeypatch, name, run):
    one = Tally(passed=1)
    monkeypatch.setattr(windows_suite, "native", lambda: one)
    monkeypatch.setattr(windows_suite, "python_suite", lambda python: one)
    monkeypatch.setattr(windows_suite, "surfaces", lambda python: one)
    assert suites.suite_named(name)() == dict.fromkeys(run, one)


@pytest.mark.parametrize("name", ["windows:cp99", "native:stencil"])
def test_other_parts_are_refused(name):
    with pytest.raises(DevError, match="part"):
        suites.suite_named(name)()


def test_every_windows_python_has_its_packages():
    for python, path in wine.REQUIREMENTS.items():
        lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
        assert {"numpy", "scipy", "pytest"} <= {line.partition("==")[0] for line in lines}, python
        assert all(" --hash=sha256:" in line for line in lines), python


def test_the_library_for_wine_has_complex_functions_and_passes_others_on():
    lines = wine_complex.definition({"sin", "creal", "cexpl"}).splitlines()
    exports = dict(line.strip().split("=") for line in lines[2:])
    assert exports["sin"] == "ucrtbase.sin"
    assert exports["creal"] == "df_creal" and exports["creall"] == "df_creal"
    assert exports["cexpl"] == "df_cexp" and exports["cpowf"] == "df_cpowf"


def test_a_module_is_sent_to_the_library_for_wine(tmp_path):
    module = tmp_path / "module.pyd"
    module.write_bytes(b"MZ " + wine_complex.THEIRS.encode() + b"\0 tail")
    wine_complex.redirect(module)
    assert module.read_bytes() == b"MZ " + wine_complex.OURS.encode() + b"\0 tail"
    assert len(wine_complex.OURS) == len(wine_complex.THEIRS)
