# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite and sixty surfaces by programs for 64-bit ARM, under qemu; Debian's C library for it is unpacked."""

import shutil
from pathlib import Path

import system_packages
from layout import CACHE
from shell import DevError, run, say
from stamp import alone, fingerprint, is_fresh, leave
from suites import fresh_report, read_junit
from tally import Tally, with_exit_code

from cross import native_build, surfaces
from cross.targets import target_named

TARGET = target_named("linux-arm64")
UNPACKED = CACHE / "debian-trixie-arm64"


def unpack_debian() -> None:
    """The C library, unpacked and no more: nothing of it runs while that is done."""
    system_packages.install(["qemu-user-static", "mmdebstrap"])
    stamp, value = CACHE / f"{UNPACKED.name}.stamp", fingerprint([], "libc6")
    with alone(UNPACKED.name):
        if is_fresh(stamp, value) and UNPACKED.is_dir():
            return
        say(f"C library of Debian trixie for ARM in {UNPACKED.name}")
        shutil.rmtree(UNPACKED, ignore_errors=True)
        words = ["mmdebstrap", "--variant=extract", "--architectures=arm64", "--include=libc6"]
        if run(*words, "trixie", UNPACKED, check=False):
            raise DevError("no C library for ARM: mmdebstrap needs a reachable Debian archive.")
        leave(stamp, value)


def command(program: Path, *words: str | Path) -> list[str | Path]:
    """The command line that runs a program for ARM."""
    return ["qemu-aarch64-static", "-L", UNPACKED / "usr", program, *words]


def native() -> Tally:
    """GoogleTest's own program; qemu is ten times as slow as the machine itself."""
    report = fresh_report("native-arm64")
    words = ["--gtest_brief=1", f"--gtest_output=xml:{report}"]
    code = run(*command(native_build.program(TARGET, "fairing_tests"), *words), check=False)
    return with_exit_code(read_junit(report), code)


def compared() -> Tally:
    """The surfaces of a program for ARM and those of this machine."""
    here = CACHE / "surfaces.bin"
    surfaces.write_here(here)
    program = native_build.program(TARGET, surfaces.PROGRAM.name)
    return surfaces.compare(command(program, "compare", here))


def run_suite() -> dict[str, Tally]:
    """The tallies by what was run."""
    unpack_debian()
    return {"native": native(), "surfaces": compared()}
