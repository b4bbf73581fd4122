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
HUNG = (124, 137)  # exit codes of timeout(1)
# Over a minute each, together more than half of a Blender's time: each runs in one Blender, in turn; all other
# scripts, `nightly`, and a script given by name run in every Blender.
LONG = ["window_run.py", "window_live.py", "window_jobs.py", "headless_endurance.py"]
# They measure how long a window stops, so no other script runs beside them in the same Blender.
TIMED = ["window_gaps.py", "window_redo.py"]
LANES = 2


def install(blender: RealBlender) -> RealBlender:
    """The Blender after packing and installing the extension like a user, with separate settings."""
    blender.clear()
    made = build([blender.root.wheel()], blender)
    where = ["--repo", "user_default", "--enable", blender.seen(made)]
    run(*blender.headless("--command", "extension", "install-file", *where))
    return blender


def count(code: int, text: str, script: str) -> Tally:
    """The tally of one script from its output: each line `PASS name …` or `FAIL name …` is a test."""
    results = re.findall(r"^(PASS|FAIL) ", text, re.MULTILINE)
    tally = Tally(passed=results.count("PASS"), failed=results.count("FAIL"))
    if code in HUNG:
        return tally + Tally(failed=1, note=f"{script} did not end within {TIME_LIMIT} s")
    ran = re.search(r"^RAN (\d+)$", text, re.MULTILINE)
    if ran is None or int(ran[1]) != len(results) or not results:
        return tally + Tally(failed=1, note=f"{script} did not get to its end (exit code {code})")
    return with_exit_code(tally, code)


def counting_allocator(script: Path) -> dict[str, str]:
    """Environment variables for a script that counts memory left by a run: they select the C library's allocator.

    It reports the bytes in use, exactly if its caches for threads are off. Blender's own allocators (jemalloc, TBB's)
    keep reserves that vary by megabytes.
    """
    if not script.match(ENDURANCE):
        return {}
    tunables = {"GLIBC_TUNABLES": "glibc.malloc.tcache_count=0"}
    return {"LD_PRELOAD": "libstdc++.so.6 libc.so.6", **tunables}


def run_script(blender: RealBlender, script: Path) -> Tally:
    """Runs one script in one Blender, in a window if its name says so; then it may be tried twice."""
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
    """Runs scripts in their order, each in the lane that becomes free first."""
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
    """The long scripts that other roots run, since they take turns."""
    return {script for k, script in enumerate(LONG) if ROOTS[k % len(ROOTS)] != root}


def try_all(blender: RealBlender, wanted: str, left_out: set[str]) -> Tally:
    """Runs every script whose name contains `wanted`, except `left_out`, in one Blender with the extension."""
    folder = blender.exchange / SCRIPTS.name
    ignored = shutil.ignore_patterns("__pycache__", "images", "notes")
    for scripts in (
        SCRIPTS,
        EXAMPLES,
        ROOT / "docs",
    ):  # models and calls of these folders are tested too
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
    scripts.sort(key=lambda path: path.name not in LONG)
    lanes = blender.lanes(LANES)
    done = run_in_lanes(lanes, [script for script in scripts if script.name not in TIMED])
    done += run_in_lanes(lanes[:1], [script for script in scripts if script.name in TIMED])
    kept = SCREENSHOTS / blender.version
    shutil.rmtree(kept, ignore_errors=True)
    shutil.copytree(blender.exchange / "screenshots", kept)
    return sum(done, Tally())


def in_each(work: Callable[[RealBlender], Tally], workers: int | None = None) -> dict[str, Tally]:
    """The tally of `work` in each Blender, `workers` at a time; a Blender that cannot be made is one failure."""

    def tally(root: DebianRoot) -> Tally:
        blender = of_debian(root)
        return Tally(note=f"Blender {blender.version}") + work(blender)

    with ThreadPoolExecutor(max_workers=workers) as pool:
        found = pool.map(lambda root: attempt(partial(tally, root)), ROOTS)
        return dict(zip((root.suite for root in ROOTS), found, strict=True))


def run_suite(wanted: str = "", everything: bool = False) -> dict[str, Tally]:
    """The tallies by Blender. Long scripts run in one of them, unless they are `wanted` or `everything` is set.

    Each Blender has its own folder, settings and screen. Only one suite runs at a time, since the next one uses the
    same folders.
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
        # all before the first test: compilers use all cores, so scripts in windows would run out of time
        prepared = in_each(prepare, workers=1)
        return in_each(work)
