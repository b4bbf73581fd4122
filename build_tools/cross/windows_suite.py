# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite and the Python suite as programs for Windows, under Wine."""

import shutil
from pathlib import Path

from debian_root import INSIDE
from layout import ROOT
from shell import run
from suites import read_junit
from tally import Tally, with_exit_code

from cross import native_build, same_bits, wheels, wine
from cross.targets import target_named

TARGET = target_named("windows-x64")


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
    code = run(*words, check=False)
    return with_exit_code(read_junit(report), code)


def python_suite(python: str) -> Tally:
    """pytest in Windows' own Python."""
    (wheel,) = (path for path in wheels.build(TARGET) if f"-{python}-" in path.name)
    wine.install_wheel(wheel, wine.python_folder(python))
    report, seen = fresh(f"python-{python}.xml")
    tests = wine.windows_path(Path("/project/tests/python"))
    options = ["-q", "-p", "no:cacheprovider", f"--junitxml={seen}", tests]
    code = run(*wine.python_command(python, "-m", "pytest", *options), check=False)
    return with_exit_code(read_junit(report), code)


def surfaces(python: str) -> Tally:
    """The surfaces of Windows' Python and those of .venv."""
    hashes = same_bits.make_here(wine.WINE.outside)
    script = Path("/project", same_bits.SCRIPT.relative_to(ROOT))
    words = [wine.windows_path(script), "compare", wine.windows_path(INSIDE / hashes.name)]
    return same_bits.compare(wine.python_command(python, *words, "--arrays"))


def run_suite() -> dict[str, Tally]:
    """The tallies by what was run."""
    found = {"native": native()}
    for python in wine.REQUIREMENTS:
        found[python] = python_suite(python)
        found[f"{python} bits"] = surfaces(python)
    return found
