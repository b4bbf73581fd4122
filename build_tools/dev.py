#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""All of the project's chores, from a fresh Debian machine with nothing but python3.

python3 build_tools/dev.py demo           the main job on real meshes; results and a picture under out/
python3 build_tools/dev.py test           all tests; the last line counts them
python3 build_tools/dev.py test windows arm   the tests as programs for other machines, under Wine and qemu
python3 build_tools/dev.py test quick     what a change needs daily: form, the core, a few files of each other suite
python3 build_tools/dev.py test nightly    long scripts in every Blender, races, half an hour of new random calls
python3 build_tools/dev.py setup          system packages, .venv and the native build
python3 build_tools/dev.py fuzz --minutes N   random meshes and options until time is up; failures under out/fuzz/
python3 build_tools/dev.py bench [NAME…]  the benchmarks; JSON under out/bench/
python3 build_tools/dev.py extension      the extension's zips under out/extension/
python3 build_tools/dev.py extension --all          one for each platform: Windows, macOS and ARM are cross-compiled
python3 build_tools/dev.py extension --wheels DIR   the same, of wheels that were made elsewhere
python3 build_tools/dev.py wheels         wheels for machines of this kind under out/wheels/, by cibuildwheel
python3 build_tools/dev.py docs           the site under out/site/; a warning is an error
python3 build_tools/dev.py release        all that is published, as a folder for any static host under out/release/
python3 build_tools/dev.py release --platforms linux-x64 …   the same for these alone; --wheels DIR as for extension
python3 build_tools/dev.py pictures [NAME…]   the documents' pictures and recordings, made again and dated; --meshes DIR for the gallery
python3 build_tools/dev.py format         clang-format and ruff on all sources
"""

import sys
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable
from pathlib import Path

import native_wheel
import python_environment
import system_packages
from cross.targets import TARGETS
from layout import OUT, ROOT, VENV_PYTHON
from shell import DevError, fail, run, say
from stamp import alone


def setup_tools() -> None:
    """System packages and .venv; quick when nothing changed."""
    with alone("tools"):
        system_packages.install()
        python_environment.install()


def setup() -> None:
    """Everything that the other commands need."""
    setup_tools()
    native_wheel.install()


def demo(names: list[str]) -> int:
    """The main job, end to end."""
    setup()
    if not python_environment.has_bpy():
        fail(
            "The demo runs Blender as a Python module, which exists for Python 3.11 only: run it with python3.11."
        )
    OUT.mkdir(exist_ok=True)
    return run(VENV_PYTHON, ROOT / "examples" / "demo.py", *names, check=False)


def bench(names: list[str]) -> int:
    """The benchmarks; native ones are built first."""
    setup()
    with alone("tools"):
        system_packages.install(system_packages.BENCHMARKS)
        python_environment.install_rivals()
    run("cmake", "--preset", "bench")
    run("cmake", "--build", "--preset", "bench")
    (OUT / "bench").mkdir(parents=True, exist_ok=True)
    return run(VENV_PYTHON, ROOT / "benchmarks" / "run.py", *names, check=False)


def test(names: list[str]) -> int:
    """All suites; those that need the wheel build it, so that the others run even where it cannot be built."""
    import suites

    setup_tools()
    return suites.run_all(names)


def fuzz(minutes: float) -> int:
    """Random calls of the package."""
    import fuzzing

    setup_tools()
    return fuzzing.fuzz(minutes)


def extension(wheels: Path | None, all_platforms: bool) -> None:
    """One zip for each platform, of the wheels in a folder or compiled here; else for each Python that is available."""
    import extension as packing

    setup_tools()
    if wheels is not None:
        found = packing.wheels_in(wheels.resolve())
    else:
        found = packing.wheels_of_platforms() if all_platforms else packing.wheels_at_hand()
    for path in packing.build_all(found):
        say(f"{path.relative_to(ROOT)} is ready")


def wheels_of_this_machine() -> int:
    """Wheels for every Python, by cibuildwheel in the Python that runs this; on Linux in a container."""
    lock = ROOT / "build_tools" / "requirements_wheels.lock"
    run(sys.executable, "-m", "pip", "install", "--require-hashes", "--requirement", lock)
    return run(sys.executable, "-m", "cibuildwheel", "--output-dir", OUT / "wheels", check=False)


def release(wheels: Path | None, platforms: list[str] | None) -> None:
    """Everything that is published, of the wheels in a folder or compiled here for the platforms."""
    import extension as packing
    import release as publishing

    setup_tools()
    found = (
        packing.wheels_in(wheels.resolve()) if wheels else packing.wheels_of_platforms(platforms)
    )
    say(f"{publishing.build(found).relative_to(ROOT)} is ready")


def docs() -> None:
    """The site, of the documents and docstrings."""
    import site_pages

    setup_tools()
    say(f"{site_pages.build().relative_to(ROOT)}/index.html is ready")


def make_pictures(names: list[str], meshes: Path | None) -> int:
    """The documents' pictures."""
    import pictures

    setup()
    return pictures.make(names, meshes)


def format_sources() -> int:
    """Rewrites the sources in the project's style."""
    import style

    setup_tools()
    return style.rewrite()


COMMANDS: dict[str, Callable[[Namespace], int | None]] = {
    "setup": lambda given: setup(),
    "test": lambda given: test(given.names),
    "demo": lambda given: demo(given.names),
    "fuzz": lambda given: fuzz(given.minutes),
    "bench": lambda given: bench(given.names),
    "extension": lambda given: extension(given.wheels, given.all),
    "wheels": lambda given: wheels_of_this_machine(),
    "docs": lambda given: docs(),
    "pictures": lambda given: make_pictures(given.names, given.meshes),
    "release": lambda given: release(given.wheels, given.platforms),
    "format": lambda given: format_sources(),
}


def main() -> int:
    """Runs one command; the exit code is the process's."""
    if sys.version_info < (3, 11):  # noqa: UP036
        raise DevError("python3 has to be 3.11 or newer.")
    parser = ArgumentParser(description=__doc__, formatter_class=RawDescriptionHelpFormatter)
    add, names = parser.add_argument, [target.name for target in TARGETS]
    add("command", choices=COMMANDS)
    only = "bench, demo, pictures, test: only these; test blender:TEXT: parts so named"
    add("names", nargs="*", help=only)
    add("--meshes", type=Path, metavar="DIR", help="pictures: the gallery's meshes of others")
    add("--wheels", type=Path, metavar="DIR", help="extension, release: pack this folder's wheels")
    add("--platforms", nargs="+", choices=names, help="release: for these; by default for all")
    add("--minutes", type=float, default=10.0, metavar="N", help="fuzz: how long; 10 by default")
    add("--all", action="store_true", help="extension: compile and pack for every platform")
    given = parser.parse_args()
    return COMMANDS[given.command](given) or 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except DevError as error:
        fail(str(error))
