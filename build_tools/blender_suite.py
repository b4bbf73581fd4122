# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's own zip, installed and used in every real Blender that is available, without a window and in one."""

import re
import shutil
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from queue import SimpleQueue

from debian_root import ROOTS, DebianRoot
from extension import build
from layout import OUT, ROOT
from real_blender import TIME_LIMIT, RealBlender, of_debian
from shell import output, run, say
from stamp import alone
from tally import Tally, attempt, with_exit_code

SCRIPTS = ROOT / "tests" / "blender"
EXAMPLES = ROOT / "examples"
SCREENSHOTS = OUT / "screenshots"
HEADLESS, WINDOW, ENDURANCE = "headless_*.py", "window_*.py", "*_endurance.py"
HUNG = (124, 137)  # what timeout(1) ends with
# Over a minute each: all of them take more than half of a Blender's time. Every one runs in one Blender, all others
# in each; `nightly`, and a script that is named, in every Blender. In turn: so each Blender has about as much to do.
LONG = ["window_run.py", "window_live.py", "window_jobs.py", "headless_endurance.py"]
# They time how long a window stops, so nothing else of the suite runs beside them in the same Blender.
TIMED = ["window_gaps.py", "window_redo.py"]
# of scripts at a time in one Blender: they wait for half of their time
LANES = 2


def install(blender: RealBlender) -> RealBlender:
    """The Blender, with the extension packed and installed as a user would, into settings that nobody else has."""
    blender.clear()
    made = build([blender.root.wheel()], blender)
    where = ["--repo", "user_default", "--enable", blender.seen(made)]
    run(*blender.headless("--command", "extension", "install-file", *where))
    return blender


def count(code: int, text: str, script: str) -> Tally:
    """The tally of one script by what it printed: each line `PASS name …` or `FAIL name …` is a test."""
    results = re.findall(r"^(PASS|FAIL) ", text, re.MULTILINE)
    tally = Tally(passed=results.count("PASS"), failed=results.count("FAIL"))
    if code in HUNG:
        return tally + Tally(failed=1, note=f"{script} did not end within {TIME_LIMIT} s")
    ran = re.search(r"^RAN (\d+)$", text, re.MULTILINE)
    if ran is None or int(ran[1]) != len(results) or not results:
        return tally + Tally(failed=1, note=f"{script} did not get to its end (exit code {code})")
    return with_exit_code(tally, code)


def counting_allocator(script: Path) -> dict[str, str]:
    """Variables that have the C library allocate, where a script counts what a run leaves behind.

    It tells the bytes in use, and without its caches for threads these are exact. Blender's own
    allocators (jemalloc, TBB's) keep reserves that come and go by megabytes.
    """
    if not script.match(ENDURANCE):
        return {}
    tunables = {"GLIBC_TUNABLES": "glibc.malloc.tcache_count=0"}
    return {"LD_PRELOAD": "libstdc++.so.6 libc.so.6", **tunables}


def run_script(blender: RealBlender, script: Path) -> Tally:
    """One script in one Blender, in a window if its name says so; then it has a second try."""
    say(f"Blender {blender.version}: {script.name}")
    start = blender.window if script.match(WINDOW) else blender.headless
    screenshots = blender.seen(blender.exchange / "screenshots")
    arguments = ["--python-exit-code", "1", "--python", blender.seen(script)]
    variables = {"DF_SCREENSHOTS": str(screenshots), **counting_allocator(script)}
    tries = 2 if script.match(WINDOW) else 1  # a busy machine loses clicks
    for _ in range(tries):
        code, text = output(*start(*arguments, **variables))
        print(text, flush=True)
        tally = count(code, text, script.name)
        if not tally.failed:
            break
        say(f"Blender {blender.version}: {script.name} failed")
    return tally


def run_in_lanes(lanes: list[RealBlender], scripts: list[Path]) -> list[Tally]:
    """Scripts in their order, each in the lane that is free first."""
    free: SimpleQueue[RealBlender] = SimpleQueue()
    for lane in lanes:
        free.put(lane)

    def run_next(script: Path) -> Tally:
        lane = free.get()
        try:
            return run_script(lane, script)
        finally:
            free.put(lane)

    with ThreadPoolExecutor(max_workers=len(lanes)) as pool:
        return list(pool.map(run_next, scripts))


def left_to_others(root: DebianRoot) -> set[str]:
    """The long scripts that the Blender of this root does not run: they take turns."""
    return {script for k, script in enumerate(LONG) if ROOTS[k % len(ROOTS)] != root}


def try_all(blender: RealBlender, wanted: str, left_out: set[str]) -> Tally:
    """Every script whose name contains `wanted`, but for some, in one Blender that has the extension."""
    folder = blender.exchange / SCRIPTS.name
    ignored = shutil.ignore_patterns("__pycache__", "images", "notes")
    for scripts in (SCRIPTS, EXAMPLES, ROOT / "docs"):  # whose models and calls are tried
        shutil.copytree(scripts, blender.exchange / scripts.name, ignore=ignored)
    (blender.exchange / "screenshots").mkdir()
    scripts = [
        path
        for kind in (HEADLESS, WINDOW)
        for path in sorted(folder.glob(kind))
        if wanted in path.name and path.name not in left_out
    ]
    if not scripts:
        return Tally(failed=1, note=f"no script for '{wanted}'")
    # the long ones first, so that none is left at the end
    scripts.sort(key=lambda path: path.name not in LONG)
    lanes = blender.lanes(LANES)
    done = run_in_lanes(lanes, [script for script in scripts if script.name not in TIMED])
    done += run_in_lanes(lanes[:1], [script for script in scripts if script.name in TIMED])
    kept = SCREENSHOTS / blender.version
    shutil.rmtree(kept, ignore_errors=True)
    shutil.copytree(blender.exchange / "screenshots", kept)
    return sum(done, Tally())


def in_each(work: Callable[[RealBlender], Tally], workers: int | None = None) -> dict[str, Tally]:
    """What `work` counts in each Blender, `workers` at a time; one that cannot be had is one failure."""

    def tally(root: DebianRoot) -> Tally:
        blender = of_debian(root)
        return Tally(note=f"Blender {blender.version}") + work(blender)

    with ThreadPoolExecutor(max_workers=workers) as pool:
        found = pool.map(lambda root: attempt(partial(tally, root)), ROOTS)
        return dict(zip((root.suite for root in ROOTS), found, strict=True))


def run_suite(wanted: str = "", everything: bool = False) -> dict[str, Tally]:
    """The tallies by Blender; long scripts run in one of them, unless they are `wanted` or `everything` is.

    Each Blender has a folder, settings and a screen of its own. One suite at a time, as the next one takes the same
    folders.
    """

    def prepare(blender: RealBlender) -> Tally:
        install(blender)
        return Tally()

    def work(blender: RealBlender) -> Tally:
        if prepared[blender.root.suite].failed:
            return prepared[blender.root.suite]
        all_scripts = wanted or everything
        return try_all(blender, wanted, set() if all_scripts else left_to_others(blender.root))

    with alone("blender"):
        # all before the first test: compilers use all cores, and scripts in windows would run out of time
        prepared = in_each(prepare, workers=1)
        return in_each(work)
