# SPDX-License-Identifier: GPL-3.0-or-later
"""Competitors in turns (A B A B …), in wall and CPU time.

On a machine that does other work as well the wall clock tells little; CPU seconds of a run on
one thread are then the steadier figure, and on all threads they bound the wall time of an idle
machine from above.
"""

import statistics
import time
from collections.abc import Callable
from typing import Any


def measured(body: Callable[[], Any]) -> tuple[Any, float, float]:
    """Calls the body; returns its value, wall seconds and CPU seconds of all threads together."""
    wall, processor = time.perf_counter(), time.process_time()
    value = body()
    return value, time.perf_counter() - wall, time.process_time() - processor


def summary(values: list[float]) -> dict[str, Any]:
    """The median and spread of several runs."""
    return {
        "median": statistics.median(values),
        "min": min(values),
        "max": max(values),
        "runs": len(values),
    }


def in_turns(competitors: dict[str, Callable[[], Any]], repeats: int) -> dict[str, dict[str, Any]]:
    """Runs every competitor `repeats` times, one after another; the first round only warms up.

    Gives for each: "wall" and "processor" (median, min, max), and "last", what it returned.
    """
    walls: dict[str, list[float]] = {name: [] for name in competitors}
    processors: dict[str, list[float]] = {name: [] for name in competitors}
    last: dict[str, Any] = {}
    for turn in range(repeats + 1):
        for name, body in competitors.items():
            last[name], wall, processor = measured(body)
            if turn or repeats == 1:
                walls[name].append(wall)
                processors[name].append(processor)
        if repeats == 1:
            break
    return {
        name: {
            "wall": summary(walls[name]),
            "processor": summary(processors[name]),
            "last": last[name],
        }
        for name in competitors
    }
