# SPDX-License-Identifier: GPL-3.0-or-later
"""Sixty surfaces, made by the program of this machine and compared by another machine's, within a measured bound."""

import re
from pathlib import Path

from layout import BUILD
from shell import output, run
from tally import Tally

PROGRAM = BUILD / "release" / "tests" / "native" / "machines" / "fairing_surfaces"


def write_here(path: Path) -> None:
    """The surfaces of this machine, in a file."""
    run("cmake", "--preset", "release")
    run("cmake", "--build", "--preset", "release", "--target", PROGRAM.name)
    run(PROGRAM, "write", path)


def compare(command: list[str | Path]) -> Tally:
    """The tally of a command that compares with them."""
    _, text = output(*command)
    print(text, flush=True)
    return tally(text)


def tally(text: str) -> Tally:
    """How many surfaces are within their bound, by the comparison's last line."""
    found = re.search(r"^(\d+) passed, (\d+) failed", text, re.MULTILINE)
    if found is None:
        return Tally(failed=1, note="the surfaces were not compared")
    return Tally(passed=int(found[1]), failed=int(found[2]))
