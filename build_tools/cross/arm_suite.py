# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite and sixty surfaces by programs for 64-bit ARM, under qemu; Debian's packages for it are unpacked."""

import shutil
import zipfile
from pathlib import Path

import system_packages
from layout import CACHE
from shell import DevError, run, say
from stamp import alone, fingerprint, is_fresh, leave
from suites import fresh_report, read_junit
from tally import Tally, with_exit_code

from cross import native_build, same_bits, wheels
from cross.targets import target_named

TARGET = target_named("linux-arm64")
UNPACKED = CACHE / "debian-trixie-arm64"
LIBRARIES = UNPACKED / "usr" / "lib" / "aarch64-linux-gnu"
PACKAGES = ["libc6", "python3", "python3-numpy", "python3-scipy"]
PYTHON = "cp313"  # of trixie
SITE = CACHE / "arm64-site"  # our wheel


def unpack_debian() -> None:
    """The C library, Python, NumPy and SciPy, unpacked and no more: nothing of them runs while that is done."""
    system_packages.install(["qemu-user-static", "mmdebstrap"])
    stamp, value = CACHE / f"{UNPACKED.name}.stamp", fingerprint([], *PACKAGES)
    with alone(UNPACKED.name):
        if is_fresh(stamp, value) and UNPACKED.is_dir():
            return
        say(f"Python of Debian trixie for ARM in {UNPACKED.name}")
        shutil.rmtree(UNPACKED, ignore_errors=True)
        words = ["mmdebstrap", "--variant=extract", "--architectures=arm64"]
        if run(*words, f"--include={','.join(PACKAGES)}", "trixie", UNPACKED, check=False):
            raise DevError("no Python for ARM: mmdebstrap needs a reachable Debian archive.")
        leave(stamp, value)


def emulated(*words: str | Path, **variables: str) -> list[str | Path]:
    """The command line that runs a program for ARM with these variables."""
    given = [word for name, value in variables.items() for word in ("-E", f"{name}={value}")]
    return ["qemu-aarch64-static", "-L", UNPACKED / "usr", *given, *words]


def python(*words: str | Path) -> list[str | Path]:
    """The command line of Debian's Python for ARM, with NumPy and our wheel."""
    usr = UNPACKED / "usr"
    # without Debian's scripts nobody has chosen these
    algebra = f"{LIBRARIES / 'blas'}:{LIBRARIES / 'lapack'}"
    packages = f"{SITE}:{usr / 'lib' / 'python3' / 'dist-packages'}"
    places = {"PYTHONHOME": str(usr), "PYTHONPATH": packages, "LD_LIBRARY_PATH": algebra}
    program = usr / "bin" / f"python{PYTHON[2]}.{PYTHON[3:]}"
    return emulated(program, *words, PYTHONDONTWRITEBYTECODE="1", **places)


def native() -> Tally:
    """GoogleTest's own program; qemu is ten times as slow as the machine itself."""
    program, report = native_build.tests(TARGET), fresh_report("native-arm64")
    words = [program, "--gtest_brief=1", f"--gtest_output=xml:{report}"]
    code = run(*emulated(*words), check=False)
    return with_exit_code(read_junit(report), code)


def surfaces() -> Tally:
    """The wheel's surfaces and those of .venv."""
    (wheel,) = (path for path in wheels.build(TARGET) if f"-{PYTHON}-" in path.name)
    shutil.rmtree(SITE, ignore_errors=True)
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(SITE)
    hashes = same_bits.make_here(SITE)
    return same_bits.compare(python(same_bits.SCRIPT, "compare", hashes, "--arrays"))


def run_suite() -> dict[str, Tally]:
    """The tallies by what was run."""
    unpack_debian()
    return {"native": native(), f"{PYTHON} bits": surfaces()}
