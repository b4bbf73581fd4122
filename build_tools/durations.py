# SPDX-License-Identifier: GPL-3.0-or-later
"""How long each test took, read back from the JUnit reports that every suite leaves."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from pathlib import Path

from layout import BUILD

REPORTS = BUILD / "reports"
SHOWN, WORTH_SHOWING = 30, 1.0  # tests, seconds


def write_report(path: Path, seconds: Iterable[tuple[str, float]]) -> None:
    """A JUnit report of what was timed outside any test runner."""
    suite = ElementTree.Element("testsuite", name=path.stem)
    for name, time in seconds:
        ElementTree.SubElement(suite, "testcase", name=name, time=f"{time:.3f}")
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(path)


def of_report(path: Path) -> list[tuple[float, str]]:
    """Seconds and names of the tests in one report."""
    return [
        (float(case.get("time") or 0), f"{path.stem}: {case.get('name')}")
        for case in ElementTree.parse(path).iter("testcase")
    ]


def slowest(since: float) -> list[str]:
    """Lines of a table: the slowest tests of all reports written since then (seconds of the epoch)."""
    recent = [path for path in REPORTS.glob("*.xml") if path.stat().st_mtime >= since]
    rows = (row for path in recent for row in of_report(path))
    timed = sorted((row for row in rows if row[0] >= WORTH_SHOWING), reverse=True)
    if not timed:
        return []
    return [
        "the slowest tests, in seconds",
        *(f"{time:8.1f}  {name}" for time, name in timed[:SHOWN]),
    ]
