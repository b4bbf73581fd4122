# SPDX-License-Identifier: GPL-3.0-or-later
"""One million triangles through df.fair, everything included: seconds a phase, bytes a triangle.

Each run has a process of its own, so that its peak of resident memory is its own.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import table

TARGET_SECONDS, TARGET_BYTES = 1.5, 250
REPEATS = 3
CASES = {
    "triangles, L = 3": ("sphere", 28, 3),
    "triangles, L = 2": ("sphere", 56, 2),
    "triangles, L = 5": ("sphere", 7, 5),
    "quads, L = 3": ("quad_sphere", 36, 3),
    "quads, L = 2": ("quad_sphere", 72, 2),
    "quads, L = 5": ("quad_sphere", 9, 5),
}


def peak_resident_bytes() -> int:
    """Of this process alone. On Linux what getrusage() tells begins with the parent's peak."""
    status = Path("/proc/self/status")
    if status.exists():
        line = next(s for s in status.read_text().splitlines() if s.startswith("VmHWM:"))
        return 1024 * int(line.split()[1])
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def child(kind: str, size: int, levels: int, threads: int) -> dict[str, Any]:
    """The run itself, in a fresh process."""
    import hashlib

    import control_meshes
    import discrete_fairing as df
    import runs
    import timing

    mesh = getattr(control_meshes, kind)(size)
    runs.fair(
        control_meshes.sphere(1), levels=1, threads=threads
    )  # libraries loaded, threads tried
    before = peak_resident_bytes()
    result, wall, processor = timing.measured(
        lambda: df.fair(*mesh, levels=levels, threads=threads)
    )
    after = peak_resident_bytes()
    report, (triangles, quads) = result.report, result.faces
    return {
        "triangles": len(triangles) + 2 * len(quads),
        "bits": hashlib.sha256(result.vertices.data).hexdigest(),
        "wall": wall,
        "processor": processor,
        "seconds": report["seconds"],
        "iterations": report["iterations"],
        "predicted_bytes": report["predicted_bytes"],
        "peak_bytes": report["peak_bytes"],
        "resident_bytes": after - before,
    }


def spawn(case: tuple[str, int, int], threads: int) -> dict[str, Any]:
    """child() in a fresh process."""
    words = [sys.executable, __file__, *map(str, case), str(threads)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def run(cases: dict[str, tuple[str, int, int]] = CASES) -> dict[str, Any]:
    """All cases on one thread and on all, in turns."""
    result: dict[str, Any] = {}
    for _ in range(REPEATS):
        for name, case in cases.items():
            for threads in (1, 0):
                result.setdefault(f"{name}, threads {threads or 'all'}", []).append(
                    spawn(case, threads)
                )
    rows = []
    for name, entries in result.items():
        best = min(entries, key=lambda e: e["processor"])
        walls = sorted(e["wall"] for e in entries)
        phases = {k: s for k, s in best["seconds"].items() if s >= 0.0005}
        n = best["triangles"]
        rows.append(
            [
                name,
                n,
                walls[len(walls) // 2],
                f"{walls[0]:.2f} … {walls[-1]:.2f}",
                best["processor"],
                best["iterations"][-1],
                best["predicted_bytes"] / n,
                best["peak_bytes"] / n,
                best["resident_bytes"] / n,
                ", ".join(f"{k} {s:.3f}" for k, s in phases.items()),
            ]
        )
    table.show(
        f"A million triangles (targets: {TARGET_SECONDS} s on all threads, {TARGET_BYTES} bytes a triangle)",
        [
            "case",
            "triangles",
            "wall",
            "from … to",
            "processor",
            "iterations",
            "predicted B/tri",
            "peak B/tri",
            "resident B/tri",
            "seconds a phase",
        ],
        rows,
    )
    return result


if __name__ == "__main__":
    print(json.dumps(child(sys.argv[1], *map(int, sys.argv[2:5]))))
