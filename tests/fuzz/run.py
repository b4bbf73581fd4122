# SPDX-License-Identifier: GPL-3.0-or-later
"""Random calls of fair() and of the writers until time is up: python3 build_tools/dev.py fuzz --minutes N.

Each runs in a child process, which leaves the case in a file before it starts: one that kills the process is not
lost. What fails is shrunk and kept as JSON under out/fuzz/; put it into tests/fuzz/corpus/ with the mending."""

import argparse
import collections
import hashlib
import multiprocessing
import random
import tempfile
import time
import traceback
from pathlib import Path
from typing import Any

import sound
import written
from cases import Case, cases, halves
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

OUT = Path(__file__).resolve().parents[2] / "out" / "fuzz"
LAST = OUT / "last.json"
EXAMPLES = 300  # a child
FILES_EACH = 5  # children, one is for files
CHILD = settings(
    max_examples=EXAMPLES,
    deadline=None,
    database=None,
    phases=(Phase.generate, Phase.shrink),
    suppress_health_check=[*HealthCheck],
)


def search(number: int) -> None:
    """One child's work: the shrunk case of its first failure goes to OUT."""
    failed: list[tuple[Case, str]] = []
    counts: collections.Counter[str] = collections.Counter()

    @seed(number)
    @CHILD
    @given(st.one_of(cases(), cases(), cases(), halves()))
    def any_input(case: Case) -> None:
        case.write(LAST)
        try:
            counts[sound.check(case)] += 1
        except Exception:
            failed.append((case, traceback.format_exc()))
            raise

    try:
        any_input()
    except Exception:  # Hypothesis shows the last of `failed`, the smallest
        case, text = failed[-1]
        path = OUT / f"{hashlib.sha256(repr(case).encode()).hexdigest()[:12]}.json"
        case.write(path)
        print(f"{path}\n{text}", flush=True)
        raise SystemExit(1) from None
    print(f"seed {number}: " + ", ".join(f"{n} {what}" for what, n in counts.most_common()))


def search_files(number: int) -> None:
    """The same for files, whose calls are shown as they are: they hold what JSON does not have."""

    @seed(number)
    @CHILD
    @given(written.calls())
    def any_file(call: dict[str, Any]) -> None:
        with tempfile.TemporaryDirectory() as folder:
            written.check(Path(folder), call)

    any_file()


def main() -> int:
    """The exit code is 1 if anything failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=random.randrange(2**30))
    given_arguments = parser.parse_args()
    end = time.monotonic() + 60 * given_arguments.minutes
    number, failures = given_arguments.seed, 0
    OUT.mkdir(parents=True, exist_ok=True)
    context = multiprocessing.get_context("spawn")
    while time.monotonic() < end:
        target = search_files if number % FILES_EACH == 0 else search
        child = context.Process(target=target, args=(number,))
        child.start()
        child.join(max(60.0, end - time.monotonic() + 60))
        if child.is_alive():
            child.kill()
            child.join()
        if child.exitcode:
            failures += 1
        if (child.exitcode or 0) < 0 and target is search:
            path = LAST.rename(OUT / f"died-{number}.json")
            print(
                f"the process died of signal {-child.exitcode} or did not end: {path}", flush=True
            )
        number += 1
    print(f"{number - given_arguments.seed} rounds of {EXAMPLES} calls, {failures} with a failure")
    return 1 if failures else 0


if __name__ == "__main__":
    raise SystemExit(main())
