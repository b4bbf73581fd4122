# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite and the Python suite as programs for Windows, under Wine."""

import shutil
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

from debian_root import INSIDE
from layout import ROOT
from shell import DevError, run
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


@cache
def install(python: str) -> None:
    """Puts the wheel of the present sources into a Windows Python."""
    (wheel,) = (path for path in wheels.build(TARGET) if f"-{python}-" in path.name)
    wine.install_wheel(wheel, wine.python_folder(python))


def python_suite(python: str) -> Tally:
    """pytest in Windows' own Python."""
    install(python)
    report, seen = fresh(f"python-{python}.xml")
    tests = wine.windows_path(Path("/project/tests/python"))
    options = ["-q", "-p", "no:cacheprovider", f"--junitxml={seen}", tests]
    code = run(*wine.python_command(python, "-m", "pytest", *options), check=False)
    return with_exit_code(read_junit(report), code)


def surfaces(python: str) -> Tally:
    """The surfaces of Windows' Python and those of .venv."""
    install(python)
    hashes = same_bits.make_here(wine.WINE.outside)
    script = Path("/project", same_bits.SCRIPT.relative_to(ROOT))
    words = [wine.windows_path(script), "compare", wine.windows_path(INSIDE / hashes.name)]
    return same_bits.compare(wine.python_command(python, *words, "--arrays"))


def parts() -> dict[str, Callable[[], Tally]]:
    """What is run, by its name."""
    found: dict[str, Callable[[], Tally]] = {"native": native}
    for python in wine.REQUIREMENTS:
        found[python] = partial(python_suite, python)
        found[f"{python} bits"] = partial(surfaces, python)
    return found


def run_suite(wanted: str = "") -> dict[str, Tally]:
    """The tallies of the parts whose names contain `wanted`."""
    chosen = {name: part for name, part in parts().items() if wanted in name}
    if not chosen:
        raise DevError(f"no part '{wanted}' of the suite windows: there are {', '.join(parts())}.")
    return {name: part() for name, part in chosen.items()}
