# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite and the Python suite as programs for Windows, under Wine."""

import re
import shutil
from pathlib import Path

import native_wheel
from debian_root import INSIDE
from layout import ROOT, VENV_PYTHON
from shell import output, run
from suites import read_junit
from tally import Tally, with_exit_code

from cross import native_build, wheels, wine
from cross.targets import target_named

TARGET = target_named("windows-x64")
SURFACES = "tests/python/surface_hashes.py"


def fresh(name: str) -> tuple[Path, str]:
    """A report's path that is not there yet, as we see it and as Windows does."""
    path = wine.WINE.outside / name
    path.unlink(missing_ok=True)
    return path, wine.windows_path(INSIDE / name)


def native() -> Tally:
    """GoogleTest's own program."""
    wine.WINE.make()
    program = shutil.copy(native_build.tests(TARGET), wine.WINE.outside)
    report, seen = fresh("native.xml")
    inside = wine.windows_path(INSIDE / Path(program).name)
    words = wine.command(inside, "--gtest_brief=1", f"--gtest_output=xml:{seen}")
    return with_exit_code(read_junit(report), code=run(*words, check=False))


def python_suite(python: str) -> Tally:
    """pytest in Windows' own Python."""
    (wheel,) = (path for path in wheels.build(TARGET) if f"-{python}-" in path.name)
    wine.install_wheel(wheel, wine.python_folder(python))
    report, seen = fresh(f"python-{python}.xml")
    tests = wine.windows_path(Path("/project/tests/python"))
    options = ["-q", "-p", "no:cacheprovider", f"--junitxml={seen}", tests]
    code = run(*wine.python_command(python, "-m", "pytest", *options), check=False)
    return with_exit_code(read_junit(report), code)


def same_bits(python: str) -> Tally:
    """Sixty surfaces, made here and by Windows' Python, compared bit by bit."""
    native_wheel.install()
    hashes = wine.WINE.outside / "hashes.json"
    run(VENV_PYTHON, ROOT / SURFACES, "write", hashes, "--arrays")
    words = [
        wine.windows_path(Path("/project", SURFACES)),
        "compare",
        wine.windows_path(INSIDE / hashes.name),
    ]
    _, text = output(*wine.python_command(python, *words, "--arrays"))
    print(text, flush=True)
    found = re.search(r"^(\d+) of (\d+) have the same bits", text, re.MULTILINE)
    if found is None:
        return Tally(failed=1, note="the surfaces were not compared")
    return Tally(passed=int(found[1]), failed=int(found[2]) - int(found[1]))


def run_suite() -> dict[str, Tally]:
    """The tallies by what was run."""
    found = {"native": native()}
    for python in wine.REQUIREMENTS:
        found[python] = python_suite(python)
        found[f"{python} bits"] = same_bits(python)
    return found
