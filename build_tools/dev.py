#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""All of the project's chores, from a fresh Debian machine with nothing but python3: dev.py COMMAND, of these:"""

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

COMMANDS: dict[str, Callable[[Namespace], int | None]] = {}


def command(work: Callable[[Namespace], int | None]) -> Callable[[Namespace], int | None]:
    """Makes a function a command of its name."""
    COMMANDS[work.__name__] = work
    return work


def setup_tools() -> None:
    """System packages and .venv; quick when nothing changed."""
    with alone("tools"):
        system_packages.install()
        python_environment.install()


@command
def setup(_given: Namespace) -> None:
    """System packages, .venv and the native build."""
    setup_tools()
    native_wheel.install()


@command
def demo(given: Namespace) -> int:
    """The main job on real meshes; results and a picture under out/."""
    setup(given)
    if not python_environment.has_bpy():
        fail(
            "The demo runs Blender as a Python module, which exists for Python 3.11 only: run it with python3.11."
        )
    OUT.mkdir(exist_ok=True)
    return run(VENV_PYTHON, ROOT / "examples" / "demo.py", *given.names, check=False)


@command
def bench(given: Namespace) -> int:
    """The benchmarks; JSON under out/bench/."""
    setup(given)
    with alone("tools"):
        system_packages.install(system_packages.BENCHMARKS)
        python_environment.install_rivals()
    run("cmake", "--preset", "bench")
    run("cmake", "--build", "--preset", "bench")
    (OUT / "bench").mkdir(parents=True, exist_ok=True)
    return run(VENV_PYTHON, ROOT / "benchmarks" / "run.py", *given.names, check=False)


@command
def test(given: Namespace) -> int:
    """All suites, or those named; the last line counts the tests. By name alone: windows, arm, nightly."""
    from suites import run_all

    setup_tools()  # not the wheel: suites that need it build it, so that the others run where it cannot be built
    return run_all(given.names)


@command
def fuzz(given: Namespace) -> int:
    """Random meshes and options until time is up; failures under out/fuzz/."""
    import fuzzing

    setup_tools()
    return fuzzing.fuzz(given.minutes)


@command
def extension(given: Namespace) -> None:
    """The extension's zips under out/extension/: for each Python that is available, or --all or --wheels."""
    import extension as packing

    setup_tools()
    some = given.wheels or given.all
    for path in packing.build_all(packing.zips(given.wheels) if some else packing.wheels_at_hand()):
        say(f"{path.relative_to(ROOT)} is ready")


@command
def wheels(_given: Namespace) -> int:
    """Wheels for machines of this kind under out/wheels/, by cibuildwheel in the Python that runs this."""
    lock = ROOT / "build_tools" / "requirements_wheels.lock"
    run(sys.executable, "-m", "pip", "install", "--require-hashes", "--requirement", lock)
    return run(sys.executable, "-m", "cibuildwheel", "--output-dir", OUT / "wheels", check=False)


@command
def release(given: Namespace) -> None:
    """All that is published, for any static host, under out/release/, of --wheels or of --platforms."""
    import extension as packing
    import release as publishing

    setup_tools()
    made = publishing.build(packing.zips(given.wheels, given.platforms))
    say(f"{made.relative_to(ROOT)} is ready")


@command
def docs(_given: Namespace) -> None:
    """The site under out/site/; a warning is an error."""
    import site_pages

    setup_tools()
    say(f"{site_pages.build().relative_to(ROOT)}/index.html is ready")


@command
def pictures(given: Namespace) -> int:
    """The documents' pictures and recordings, made again and dated; --meshes for the gallery."""
    from pictures import make

    setup(given)
    return make(given.names, given.meshes)


@command
def format(_given: Namespace) -> int:
    """Rewrites all sources in the project's style, by clang-format and ruff."""
    import style

    setup_tools()
    return style.rewrite()


def main() -> int:
    """Runs one command; the exit code is the process's."""
    if sys.version_info < (3, 11):  # noqa: UP036
        raise DevError("python3 has to be 3.11 or newer.")
    listed = [f"  {name:<10} {work.__doc__}" for name, work in COMMANDS.items()]
    words = "\n".join([str(__doc__), "", *listed])
    parser = ArgumentParser(description=words, formatter_class=RawDescriptionHelpFormatter)
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
