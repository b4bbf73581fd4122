# SPDX-License-Identifier: GPL-3.0-or-later
"""Sixty surfaces, made here and by another machine's Python, compared bit by bit."""

import re
from pathlib import Path

import native_wheel
from layout import ROOT, VENV_PYTHON
from shell import output, run
from tally import Tally

SCRIPT = ROOT / "tests" / "python" / "surface_hashes.py"


def make_here(folder: Path) -> Path:
    """The surfaces of .venv, hashes and coordinates, in a file of this folder."""
    native_wheel.install()
    hashes = folder / "hashes.json"
    run(VENV_PYTHON, SCRIPT, "write", hashes, "--arrays")
    return hashes


def compare(command: list[str | Path]) -> Tally:
    """The tally of a command that compares with them."""
    _, text = output(*command)
    print(text, flush=True)
    return tally(text)


def tally(text: str) -> Tally:
    """How many surfaces have the same bits, by what the comparison said."""
    found = re.search(r"^(\d+) of (\d+) have the same bits", text, re.MULTILINE)
    if found is None:
        return Tally(failed=1, note="the surfaces were not compared")
    return Tally(passed=int(found[1]), failed=int(found[2]) - int(found[1]))
