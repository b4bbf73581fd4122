# SPDX-License-Identifier: GPL-3.0-or-later
"""The test suites, one after the other, and their sum."""

import os
import re
import shutil
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import monotonic

import native_wheel
import style
from extension import build
from layout import BUILD, ROOT, VENV_PYTHON
from python_environment import has_bpy
from real_blender import RealBlender, find
from shell import DevError, output, run, say

REPORTS = BUILD / "reports"


@dataclass
class Tally:
    """How many tests of a suite ended how."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    note: str = ""


def read_junit(report: Path) -> Tally:
    """Counts a JUnit report of CTest or pytest; an absent or empty one is a failure."""
    if not report.is_file():
        return Tally(failed=1, note="ended without a report")
    cases = list(ElementTree.parse(report).iter("testcase"))
    bad = sum(case.find("failure") is not None or case.find("error") is not None for case in cases)
    skipped = sum(case.find("skipped") is not None for case in cases)
    if not cases:
        return Tally(failed=1, note="no tests found")
    return Tally(len(cases) - bad - skipped, bad, skipped)


def with_exit_code(tally: Tally, code: int) -> Tally:
    """A program that fails although none of its tests did counts as one failure."""
    if code != 0 and tally.failed == 0:
        tally.failed, tally.note = 1, f"exit code {code}"
    return tally


def fresh_report(name: str) -> Path:
    """The path of a report that is not there yet."""
    REPORTS.mkdir(parents=True, exist_ok=True)
    path = REPORTS / f"{name}.xml"
    path.unlink(missing_ok=True)
    return path


def style_suite() -> Tally:
    """Form of the sources: one check a tool."""
    codes = [run(*command, check=False) for command in style.checks().values()]
    return Tally(passed=codes.count(0), failed=len(codes) - codes.count(0))


def native_suite(preset: str) -> Tally:
    """GoogleTest through CTest, of one preset."""
    report = fresh_report(f"native-{preset}")
    run("cmake", "--preset", preset)
    run("cmake", "--build", "--preset", preset)
    jobs = str(os.cpu_count() or 1)
    code = run("ctest", "--preset", preset, "--parallel", jobs, "--output-junit", report, check=False)
    return with_exit_code(read_junit(report), code)


def pytest_suite(name: str) -> Tally:
    """pytest on one folder below tests/."""
    native_wheel.install()
    report = fresh_report(name)
    code = run(VENV_PYTHON, "-m", "pytest", "-q", f"--junitxml={report}", f"tests/{name}", check=False)
    return with_exit_code(read_junit(report), code)


def addon_suite() -> Tally:
    """The add-on in the bpy module."""
    if not has_bpy():
        return Tally(note="bpy exists for Python 3.11 only: the add-on is tested in the real Blender alone")
    return pytest_suite("addon")


def blender_suite() -> Tally:
    """The extension's own zip, installed and used in a real Blender."""
    blender = find()
    blender.clear()
    made = build(blender.wheel(), blender)
    install = [
        "--command",
        "extension",
        "install-file",
        "--repo",
        "user_default",
        "--enable",
        blender.seen(made),
    ]
    run(*blender.command(*install))
    return count_smoke(blender)


def count_smoke(blender: RealBlender) -> Tally:
    """Runs tests/blender/smoke.py inside; each line `PASS name` or `FAIL name` of it is a test."""
    scripts = blender.folder / "exchange" / "tests"
    shutil.copytree(ROOT / "tests" / "blender", scripts, ignore=shutil.ignore_patterns("__pycache__"))
    script = blender.seen(scripts / "smoke.py")
    code, text = output(*blender.command("--python-exit-code", "1", "--python", script))
    print(text, flush=True)
    results = re.findall(r"^(PASS|FAIL) ", text, re.MULTILINE)
    tally = Tally(passed=results.count("PASS"), failed=results.count("FAIL"))
    if not results:
        tally = Tally(failed=1, note="the smoke run did not get to its first test")
    return with_exit_code(tally, code)


SUITES: dict[str, Callable[[], Tally]] = {
    "style": style_suite,
    "native": lambda: native_suite("release"),
    "sanitizers": lambda: native_suite("asan-ubsan"),
    "python": lambda: pytest_suite("python"),
    "addon": addon_suite,
    "blender": blender_suite,
}


def attempt(suite: Callable[[], Tally]) -> Tally:
    """A suite that cannot even run is one failure, and no reason to leave the others out."""
    try:
        return suite()
    except DevError as error:
        print(f"dev.py: {error}", flush=True)
        return Tally(failed=1, note=str(error))


def run_all(names: list[str]) -> int:
    """Runs all suites, or those named; prints a line for each and their sum last."""
    unknown = set(names) - set(SUITES)
    if unknown:
        raise DevError(f"no suite {', '.join(sorted(unknown))}; there are {', '.join(SUITES)}.")
    rows, tallies = [], []
    for name in names or SUITES:
        say(f"suite {name}")
        start = monotonic()
        tally = attempt(SUITES[name])
        tallies.append(tally)
        seconds = f"{monotonic() - start:7.1f} s"
        counts = f"{tally.passed:5} passed {tally.failed:4} failed {tally.skipped:4} skipped"
        rows.append(f"{name:<12}{counts} {seconds}  {tally.note}".rstrip())
    passed, failed = sum(t.passed for t in tallies), sum(t.failed for t in tallies)
    print("\n" + "\n".join(rows) + f"\n\n{passed} passed, {failed} failed", flush=True)
    return 1 if failed else 0
