# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the test suites one after another and counts the results."""

import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import monotonic

import blender_suite
import fuzzing
import native_wheel
import release_suite
import style
import system_packages
from cross import emulated
from layout import BUILD, VENV_PYTHON
from python_environment import has_bpy
from shell import DevError, run, say
from stamp import alone
from tally import Tally, attempt, read_junit, with_exit_code

FAULTS = ("--label-regex", "^faults$")
NO_FAULTS = ("--label-exclude", "^faults$")
NIGHT_OF_FUZZING = 30.0  # minutes
# a process for each core; tests of one file stay together, since they share fixtures
ON_ALL_CORES = ("--numprocesses=auto", "--dist=loadfile")
REPORTS = BUILD / "reports"


def fresh_report(name: str) -> Path:
    """The path of a report, after deleting an old one."""
    REPORTS.mkdir(parents=True, exist_ok=True)
    path = REPORTS / f"{name}.xml"
    path.unlink(missing_ok=True)
    return path


def style_suite() -> Tally:
    """Format of the sources: one check for each tool."""
    codes = [run(*command, check=False) for command in style.checks().values()]
    return Tally(passed=codes.count(0), failed=len(codes) - codes.count(0))


def native_suite(preset: str, *chosen: str) -> Tally:
    """GoogleTest through CTest, with one preset; `chosen`: CTest options that select tests."""
    report = fresh_report("-".join(["native", preset, *(["faults"] if chosen == FAULTS else [])]))
    run("cmake", "--preset", preset)
    run("cmake", "--build", "--preset", preset)
    jobs = str(os.cpu_count() or 1)
    words = ["--preset", preset, "--parallel", jobs, "--output-junit", report, *chosen]
    code = run("ctest", *words, check=False)
    return with_exit_code(read_junit(report), code)


def pytest_suite(name: str, *options: str, **environment: str) -> Tally:
    """pytest on one folder or file below tests/."""
    native_wheel.install()
    report = fresh_report(name.replace("/", "-"))
    shown = ["-q", "--durations=10", "--durations-min=1", f"--junitxml={report}"]
    command = [VENV_PYTHON, "-m", "pytest", *shown, f"tests/{name}"]
    code = run(*command, *options, check=False, **environment)
    return with_exit_code(read_junit(report), code)


def fuzz_suite() -> Tally:
    """A fixed number of random calls, and the corpus."""
    return pytest_suite("fuzz", *ON_ALL_CORES, **fuzzing.sanitized_environment())


def addon_suite() -> Tally:
    """The add-on in the bpy module."""
    if not has_bpy():
        return Tally(note="bpy exists for Python 3.11 only: tested in the real Blender alone")
    return pytest_suite("addon", *ON_ALL_CORES)


def site_suite() -> Tally:
    """Builds the site and tests it in a browser."""
    with alone("tools"):
        system_packages.install(system_packages.SITE)
    return pytest_suite("site")


def table_line(name: str, tally: Tally, seconds: float | None = None) -> str:
    """One line of the table at the end."""
    counts = f"{tally.passed:5} passed {tally.failed:4} failed {tally.skipped:4} skipped"
    time = f"{seconds:7.1f} s" if seconds is not None else " " * 9
    return f"{name:<16}{counts} {time}  {tally.note}".rstrip()


SUITES: dict[str, Callable[[], Tally | dict[str, Tally]]] = {
    "style": style_suite,
    "native": lambda: native_suite("release", *NO_FAULTS),
    "sanitizers": lambda: native_suite("asan-ubsan", *NO_FAULTS),
    # allocations that fail, to find leaks and double frees
    "faults": lambda: native_suite("asan-ubsan", *FAULTS),
    "python": lambda: pytest_suite("python", *ON_ALL_CORES),
    "fuzz": fuzz_suite,
    "addon": addon_suite,
    "build_tools": lambda: pytest_suite("build_tools"),
    "site": site_suite,
    "blender": blender_suite.run_suite,
    "release": release_suite.run_suite,
}


def nightly_suite() -> dict[str, Tally]:
    """Suites too long for every day: long scripts in every Blender, races between threads, new random calls."""
    blenders = blender_suite.run_suite(everything=True)
    fuzz_failed = fuzzing.fuzz(NIGHT_OF_FUZZING) != 0  # new random calls at each run
    return {
        **{f"Blender of {place}": tally for place, tally in blenders.items()},
        "races, native": native_suite(fuzzing.THREADS, *NO_FAULTS),
        "races, package": pytest_suite(
            "python/test_threads.py", **fuzzing.sanitized_environment(fuzzing.THREADS)
        ),
        "fuzz": Tally(passed=int(not fuzz_failed), failed=int(fuzz_failed)),
    }


# only by name, since each takes half an hour
LONG_SUITES: dict[str, Callable[[], Tally | dict[str, Tally]]] = {
    "windows": emulated.windows,
    "arm": emulated.arm,
    "nightly": nightly_suite,
}


def suite_named(name: str) -> Callable[[], Tally | dict[str, Tally]]:
    """A suite; `blender:TEXT` is the part whose scripts' names contain TEXT."""
    suite, _, part = name.partition(":")
    if part and suite != "blender":
        raise DevError(f"only parts of blender can be named, not of {suite}.")
    return partial(blender_suite.run_suite, part) if part else {**SUITES, **LONG_SUITES}[suite]


def run_all(names: list[str]) -> int:
    """Runs all suites, or those named; prints a line for each and their sum last."""
    known = {**SUITES, **LONG_SUITES}
    unknown = {name.partition(":")[0] for name in names} - set(known)
    if unknown:
        raise DevError(f"no suite {', '.join(sorted(unknown))}; there are {', '.join(known)}.")
    rows, total = [], Tally()
    for name in names or SUITES:
        say(f"suite {name}")
        start = monotonic()
        result = attempt(suite_named(name))
        parts = result if isinstance(result, dict) else {}
        whole = sum(parts.values(), Tally()) if parts else result
        total += whole
        shown = replace(whole, note="") if parts else whole
        rows.append(table_line(name, shown, monotonic() - start))
        rows += [table_line(f"  {part}", tally) for part, tally in parts.items()]
    print("\n".join(["", *rows]))
    print(f"\n{total.passed} passed, {total.failed} failed", flush=True)
    return 1 if total.failed else 0
