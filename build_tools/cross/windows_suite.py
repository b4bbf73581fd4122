# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite and sixty surfaces by programs for Windows, run by Wine in a Debian system of its own."""

import shutil
from pathlib import Path, PureWindowsPath

from debian_root import INSIDE, DebianRoot
from shell import run
from suites import read_junit
from tally import Tally, with_exit_code

from cross import native_build, surfaces
from cross.targets import target_named

TARGET = target_named("windows-x64")
WINE = DebianRoot("trixie", "", purpose="wine", base_packages=("wine", "wine64"))


def seen(name: str) -> str:
    """The path that Wine's programs see of a file in the shared folder."""
    return str(PureWindowsPath("Z:\\", *INSIDE.parts[1:], name))


def command(program: Path, *words: str) -> list[str]:
    """The command line that runs a program for Windows; it is copied to where Wine finds it."""
    inside = seen(Path(shutil.copy(program, WINE.outside)).name)
    quiet = {"WINEDEBUG": "-all", "XDG_RUNTIME_DIR": "/tmp", "DISPLAY": ""}
    return WINE.command("wine", inside, *words, **quiet)


def native() -> Tally:
    """GoogleTest's own program."""
    report = WINE.outside / "native.xml"
    report.unlink(missing_ok=True)
    words = ["--gtest_brief=1", f"--gtest_output=xml:{seen(report.name)}"]
    code = run(*command(native_build.program(TARGET, "fairing_tests"), *words), check=False)
    return with_exit_code(read_junit(report), code)


def compared() -> Tally:
    """The surfaces of a program for Windows and those of this machine."""
    surfaces.write_here(WINE.outside / "surfaces.bin")
    program = native_build.program(TARGET, surfaces.PROGRAM.name)
    return surfaces.compare(command(program, "compare", seen("surfaces.bin")))


def run_suite() -> dict[str, Tally]:
    """The tallies by what was run."""
    WINE.make()
    return {"native": native(), "surfaces": compared()}
