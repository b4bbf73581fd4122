# SPDX-License-Identifier: GPL-3.0-or-later
"""How many tests of a suite, or of a part of it, ended how."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from shell import DevError

Result = TypeVar("Result")


@dataclass
class Tally:
    """Counts, and why they are as they are where that needs a word."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    note: str = ""

    def __add__(self, other: "Tally") -> "Tally":
        notes = [note for note in (self.note, other.note) if note]
        sums = self.passed + other.passed, self.failed + other.failed, self.skipped + other.skipped
        return Tally(*sums, note="; ".join(notes))


def with_exit_code(tally: Tally, code: int) -> Tally:
    """A program that fails although none of its tests did counts as one failure."""
    if code != 0 and tally.failed == 0:
        tally.failed, tally.note = 1, f"exit code {code}"
    return tally


def attempt(suite: Callable[[], Result]) -> "Result | Tally":
    """A suite that cannot even run is one failure, and no reason to leave the others out."""
    try:
        return suite()
    except DevError as error:
        print(f"dev.py: {error}", flush=True)
        return Tally(failed=1, note=str(error))
