# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite as a program for 64-bit ARM, under qemu: only Debian's C library for it has to be there."""

import shutil
from pathlib import Path

import system_packages
from layout import CACHE
from shell import DevError, run, say
from stamp import alone
from suites import fresh_report, read_junit
from tally import Tally, with_exit_code

from cross import native_build
from cross.targets import target_named

TARGET = target_named("linux-arm64")
LIBRARY = CACHE / "debian-trixie-arm64"


def c_library() -> Path:
    """A folder with the C library, unpacked and no more: nothing of it runs while it is made."""
    with alone(LIBRARY.name):
        if not (LIBRARY / "usr" / "lib" / "aarch64-linux-gnu" / "libc.so.6").exists():
            say(f"the C library of Debian trixie for ARM in {LIBRARY.name}")
            shutil.rmtree(LIBRARY, ignore_errors=True)
            words = ["mmdebstrap", "--variant=extract", "--architectures=arm64"]
            if run(*words, "--include=libc6", "trixie", LIBRARY, check=False):
                raise DevError("no C library for ARM: mmdebstrap needs a reachable Debian archive.")
    return LIBRARY


def run_suite() -> Tally:
    """GoogleTest's own program; qemu is ten times as slow as the machine itself."""
    system_packages.install(["qemu-user-static", "mmdebstrap"])
    report = fresh_report("native-arm64")
    emulated = ["qemu-aarch64-static", "-L", c_library() / "usr", native_build.tests(TARGET)]
    code = run(*emulated, "--gtest_brief=1", f"--gtest_output=xml:{report}", check=False)
    return with_exit_code(read_junit(report), code)
