# SPDX-License-Identifier: GPL-3.0-or-later
"""The native core, compiled for another platform by zig's clang: its modules and its tests."""

import os
from pathlib import Path

import system_packages
from layout import BUILD, ROOT
from native_wheel import local_version
from python_environment import pybind11
from shell import DevError, run
from wheel_version import version

from cross.python_parts import headers, import_library
from cross.sources import openmesh, zig
from cross.targets import Target

TOOLCHAIN = ROOT / "build_tools" / "cross" / "toolchain.cmake"
GOOGLETEST = Path("/usr/src/googletest")  # from Debian's libgtest-dev


def build_folder(target: Target) -> Path:
    """One for all Pythons: the core is compiled once, the binding for each."""
    return BUILD / "cross" / target.name


def settings(target: Target) -> dict[str, str | Path]:
    """CMake's variables that do not depend on the Python."""
    return {
        "CMAKE_TOOLCHAIN_FILE": TOOLCHAIN,
        "CMAKE_BUILD_TYPE": "Release",
        "DF_ZIG": zig(),
        "DF_ZIG_TARGET": target.zig,
        "DF_WARNINGS_AS_ERRORS": "ON",
        "FETCHCONTENT_SOURCE_DIR_OPENMESH": openmesh(),
        "pybind11_DIR": pybind11(),
        "SKBUILD_PROJECT_VERSION_FULL": version(local_version()),
    }


def python_settings(target: Target, python: str) -> dict[str, str | Path]:
    """CMake's variables for the binding's Python."""
    found: dict[str, str | Path] = {
        "Python_INCLUDE_DIR": headers(target, python),
        "PYTHON_MODULE_EXTENSION": target.suffix(python),
        "PYTHON_IS_DEBUG": "OFF",
    }
    if target.is_windows:
        found["Python_LIBRARY"] = import_library(python)
    return found


def configure(target: Target, variables: dict[str, str | Path]) -> None:
    """Runs CMake in a target's folder."""
    forget = ["-UPython_*", "-U_Python_*"]  # results of CMake for another Python
    words = [*forget, *(f"-D{name}={value}" for name, value in variables.items())]
    run("cmake", "-G", "Ninja", "-S", ROOT, "-B", build_folder(target), *words)


def build(target: Target, name: str) -> None:
    """Builds one of CMake's targets."""
    jobs = str(os.cpu_count() or 1)
    run("cmake", "--build", build_folder(target), "--target", name, "--parallel", jobs)


def module(target: Target, python: str) -> Path:
    """The extension module for one Python."""
    configure(
        target,
        {**settings(target), "DF_BUILD_PYTHON": "ON", **python_settings(target, python)},
    )
    build(target, "_native")
    made = build_folder(target) / "native" / "binding" / f"_native{target.suffix(python)}"
    if target.is_windows:
        return made
    what = ["--strip-debug", "--discard-all"] if target.is_macos else ["--strip-all"]
    return stripped(made, *what)


def stripped(made: Path, *what: str) -> Path:
    """A module without data for debuggers from zig's own libraries: two thirds of it on Linux; on macOS they contain
    the path of the build folder.

    The linker could leave them out, but then zig builds its libraries again.
    """
    system_packages.install(["llvm"])
    path = made.parent / "stripped" / made.name
    path.parent.mkdir(exist_ok=True)
    run("llvm-strip", *what, "-o", path, made)
    return path


def program(target: Target, name: str) -> Path:
    """A program of the native tests."""
    if not GOOGLETEST.is_dir():
        raise DevError(f"GoogleTest's sources are not in {GOOGLETEST}: install libgtest-dev.")
    wanted = {"DF_BUILD_TESTS": "ON", "DF_GOOGLETEST_SOURCE": GOOGLETEST, "DF_BUILD_PYTHON": "OFF"}
    configure(target, {**settings(target), **wanted})
    build(target, name)
    (made,) = (
        path
        for path in (build_folder(target) / "tests").rglob(f"{name}*")
        if path.is_file() and path.suffix in ("", ".exe")
    )
    return made
