# SPDX-License-Identifier: GPL-3.0-or-later
"""The native suite and sixty surfaces by programs for other machines: for Windows under Wine, in a Debian system of its
own, and for 64-bit ARM under qemu, with Debian's C library for it unpacked."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path, PureWindowsPath

import system_packages
from debian_root import INSIDE, DebianRoot
from layout import BUILD, CACHE
from shell import DevError, output, run, say
from stamp import alone, fingerprint, is_fresh, leave
from tally import Tally, read_junit, with_exit_code

from cross import native_build
from cross.targets import Target, target_named

SURFACES = BUILD / "release" / "tests" / "native" / "machines" / "fairing_surfaces"
WINE = DebianRoot("trixie", "", purpose="wine", base_packages=("wine", "wine64"))
ARM_LIBRARY = CACHE / "debian-trixie-arm64"


def tally(text: str) -> Tally:
    """The tally of surfaces within their measured bound, from the comparison's last line."""
    found = re.search(r"^(\d+) passed, (\d+) failed", text, re.MULTILINE)
    if found is None:
        return Tally(failed=1, note="the surfaces were not compared")
    return Tally(passed=int(found[1]), failed=int(found[2]))


def tallies(
    target: Target, folder: Path, seen: Callable[[Path], str], start: Callable[..., list]
) -> dict[str, Tally]:
    """Runs the target's GoogleTest program, and compares its surfaces with this machine's.

    `seen`: the path in `folder` for the target's programs; `start`: the command line that runs one.
    """
    report, surfaces = folder / "native.xml", folder / "surfaces.bin"
    report.unlink(missing_ok=True)
    words = ["--gtest_brief=1", f"--gtest_output=xml:{seen(report)}"]
    code = run(*start(native_build.program(target, "fairing_tests"), *words), check=False)
    run("cmake", "--preset", "release")
    run("cmake", "--build", "--preset", "release", "--target", SURFACES.name)
    run(SURFACES, "write", surfaces)
    program = native_build.program(target, SURFACES.name)
    _, text = output(*start(program, "compare", seen(surfaces)))
    print(text, flush=True)
    return {"native": with_exit_code(read_junit(report), code), "surfaces": tally(text)}


def windows() -> dict[str, Tally]:
    """Under Wine; programs are copied into its folder."""
    WINE.make()
    quiet = {"WINEDEBUG": "-all", "XDG_RUNTIME_DIR": "/tmp", "DISPLAY": ""}

    def seen(path: Path) -> str:
        return str(PureWindowsPath("Z:\\", *INSIDE.parts[1:], path.name))

    def start(program: Path, *words: str) -> list[str]:
        inside = seen(Path(shutil.copy(program, WINE.outside)))
        return WINE.command("wine", inside, *words, **quiet)

    return tallies(target_named("windows-x64"), WINE.outside, seen, start)


def arm() -> dict[str, Tally]:
    """Under qemu, which is ten times as slow as the machine itself."""
    unpack_arm_library()
    qemu = ["qemu-aarch64-static", "-L", ARM_LIBRARY / "usr"]
    return tallies(target_named("linux-arm64"), CACHE, str, lambda *words: [*qemu, *words])


def unpack_arm_library() -> None:
    """Unpacks the C library without running any of its scripts."""
    system_packages.install(["qemu-user-static", "mmdebstrap"])
    stamp, value = CACHE / f"{ARM_LIBRARY.name}.stamp", fingerprint([], "libc6")
    with alone(ARM_LIBRARY.name):
        if is_fresh(stamp, value) and ARM_LIBRARY.is_dir():
            return
        say(f"C library of Debian trixie for ARM in {ARM_LIBRARY.name}")
        shutil.rmtree(ARM_LIBRARY, ignore_errors=True)
        words = ["mmdebstrap", "--variant=extract", "--architectures=arm64", "--include=libc6"]
        if run(*words, "trixie", ARM_LIBRARY, check=False):
            raise DevError("no C library for ARM: mmdebstrap needs a reachable Debian archive.")
        leave(stamp, value)
