# SPDX-License-Identifier: GPL-3.0-or-later
"""Random calls of the package, as built and with sanitizers."""

import shutil
from pathlib import Path

import native_wheel
from layout import BUILD, ROOT, VENV_PYTHON
from python_environment import pybind11
from shell import output, run

TESTS = ROOT / "tests" / "fuzz"
ADDRESSES, THREADS = "asan-ubsan", "tsan"  # presets
LIBRARIES = {ADDRESSES: ("libasan.so", "libubsan.so"), THREADS: ("libtsan.so",)}


def fuzz(minutes: float) -> int:
    """Runs until the time is over; returns the exit code 1 if anything failed."""
    native_wheel.install()
    meshes = str(ROOT / "tests" / "python")  # shared with other tests
    arguments = ("--minutes", str(minutes))
    return run(VENV_PYTHON, TESTS / "run.py", *arguments, check=False, PYTHONPATH=meshes)


def sanitized_package(preset: str) -> Path:
    """A folder from which discrete_fairing is imported, built with the preset's sanitizers."""
    found = [f"-Dpybind11_DIR={pybind11()}", f"-DPython_EXECUTABLE={VENV_PYTHON}"]
    run("cmake", "--preset", preset, "-DDF_BUILD_PYTHON=ON", *found)
    run("cmake", "--build", "--preset", preset, "--target", "_native")
    folder = BUILD / preset / "package"
    shutil.rmtree(folder, ignore_errors=True)
    package = folder / "discrete_fairing"
    shutil.copytree(ROOT / "native" / "binding" / "discrete_fairing", package)
    for module in (BUILD / preset).rglob("_native*.so"):
        shutil.copy(module, package)
    return folder


def sanitized_environment(preset: str = ADDRESSES) -> dict[str, str]:
    """Environment variables by which a plain Python loads the preset's sanitizers."""
    libraries = [output("g++", f"-print-file-name={name}")[1].strip() for name in LIBRARIES[preset]]
    return {
        "PYTHONPATH": str(sanitized_package(preset)),
        "LD_PRELOAD": " ".join(libraries),
        # Python does not free all memory at exit; a refused allocation must reach our code
        "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1",
        "UBSAN_OPTIONS": "print_stacktrace=1:halt_on_error=1",
        "PYTHONMALLOC": "malloc",
    }
