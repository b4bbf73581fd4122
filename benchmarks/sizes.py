# SPDX-License-Identifier: GPL-3.0-or-later
"""From 50 thousand to 10 million triangles, everything included: seconds, memory, the second core,
the same bits.

BENCH_HUNDRED=1 adds a hundred million, which take some 20 GB and minutes. Each run has a process of
its own, so that its peak of resident memory is its own.
"""

import os
import statistics
from typing import Any

import numpy as np
import one_run
import table

REPEATS = 3
ONCE_FROM = 5_000_000  # triangles
SERIES = {
    "L = 3": [("sphere", m, 3) for m in (6, 12, 25, 50, 88)],
    "by levels": [("sphere", 6, level) for level in (3, 4, 5, 6, 7)],
    "quads, L = 2": [("quad_sphere", m, 2) for m in (16, 32, 64, 128, 228)],
}
HUNDRED_MILLIONS = {
    "L = 3": ("sphere", 280, 3),
    "by levels": ("sphere", 9, 8),
    "quads, L = 2": ("quad_sphere", 722, 2),
}
FACES = {"sphere": 20, "quad_sphere": 12}  # in triangles


def triangles(case: tuple[str, int, int]) -> int:
    """The number of triangles of the refined surface."""
    kind, size, levels = case
    return FACES[kind] * size**2 * 4**levels


def exponent(sizes: list[float], seconds: list[float]) -> float:
    """The slope of log seconds over log size."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])


def measure(case: tuple[str, int, int]) -> dict[str, Any]:
    """Measures one size on one thread and on two threads, in turns."""
    repeats = 1 if triangles(case) >= ONCE_FROM else REPEATS
    found: dict[int, list[dict[str, Any]]] = {1: [], 2: []}
    for _ in range(repeats):
        for threads, entries in found.items():
            entries.append(one_run.spawn(case, threads))
    one, two = found[1][0], found[2][0]
    count = two["triangles"]
    return {
        "triangles": count,
        "wall": {t: statistics.median(e["wall"] for e in entries) for t, entries in found.items()},
        "processor": min(e["processor"] for e in found[1]),
        "iterations": one["iterations"],
        "predicted": two["predicted_bytes"] / count,
        "ledger": two["peak_bytes"] / count,
        "resident": max(e["resident_bytes"] for e in found[2]) / count,
        "same_bits": len({e["bits"] for entries in found.values() for e in entries}) == 1,
    }


def run() -> dict[str, Any]:
    """Measures all series."""
    hundred = os.environ.get("BENCH_HUNDRED") == "1"
    result: dict[str, Any] = {}
    for name, cases in SERIES.items():
        points = [
            measure(case) for case in [*cases, HUNDRED_MILLIONS[name]][: None if hundred else -1]
        ]
        sizes = [p["triangles"] for p in points]
        slopes = {
            "one thread": exponent(sizes, [p["wall"][1] for p in points]),
            "two": exponent(sizes, [p["wall"][2] for p in points]),
            "processor": exponent(sizes, [p["processor"] for p in points]),
        }
        result[name] = {"points": points, "exponents": slopes}
    return result


LABELS = {
    "L = 3": "small faces: level 3",
    "by levels": "large faces: more levels",
    "quads, L = 2": "quads, level 2",
}


def sizes_table(result: dict[str, Any]) -> str:
    """Processor time and memory by the number of triangles."""
    heads = ["control mesh", "triangles", "CPU seconds"]
    heads += ["iterations", "bytes a triangle"]
    rows = [
        [
            label,
            f"{p['triangles']:,}",
            table.short(p["processor"]),
            str(p["iterations"][-1]),
            f"{p['resident']:.0f}",
        ]
        for key, label in LABELS.items()
        for p in result[key]["points"]
    ]
    return table.markdown(heads, rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "sizes": sizes_table(result),
    }
