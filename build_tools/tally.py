# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts of a suite's tests by outcome."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from shell import DevError

Result = TypeVar("Result")


@dataclass
class Tally:
    """Counts, and notes that explain them."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    note: str = ""

    def __add__(self, other: "Tally") -> "Tally":
        notes = [note for note in (self.note, other.note) if note]
        sums = self.passed + other.passed, self.failed + other.failed, self.skipped + other.skipped
        return Tally(*sums, note="; ".join(notes))


def read_junit(report: Path) -> Tally:
    """Counts of a JUnit report of CTest or pytest; a missing or empty one is a failure."""
    if not report.is_file():
        return Tally(failed=1, note="ended without a report")
    cases = list(ElementTree.parse(report).iter("testcase"))
    bad = sum(case.find("failure") is not None or case.find("error") is not None for case in cases)
    skipped = sum(case.find("skipped") is not None for case in cases)
    if not cases:
        return Tally(failed=1, note="no tests found")
    return Tally(len(cases) - bad - skipped, bad, skipped)


def with_exit_code(tally: Tally, code: int) -> Tally:
    """A program that fails without a failed test counts as one failure."""
    if code != 0 and tally.failed == 0:
        tally.failed, tally.note = 1, f"exit code {code}"
    return tally


def attempt(suite: Callable[[], Result]) -> "Result | Tally":
    """Runs a suite; if it cannot run, that is one failure, and the others continue."""
    try:
        return suite()
    except DevError as error:
        print(f"dev.py: {error}", flush=True)
        return Tally(failed=1, note=str(error))
