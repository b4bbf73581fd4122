# SPDX-License-Identifier: GPL-3.0-or-later
"""One call of df.fair in a process of its own, so that its peak of resident memory is its own."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any


def peak_resident_bytes() -> int:
    """The peak memory of this process alone. On Linux getrusage() begins with the parent's peak."""
    status = Path("/proc/self/status")
    if status.exists():
        line = next(s for s in status.read_text().splitlines() if s.startswith("VmHWM:"))
        return 1024 * int(line.split()[1])
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def child(kind: str, size: int, levels: int, threads: int) -> dict[str, Any]:
    """Runs the call in this fresh process."""
    import hashlib

    import control_meshes
    import discrete_fairing as df
    import timing

    mesh = getattr(control_meshes, kind)(size)
    df.fair(*control_meshes.sphere(1), levels=1, threads=threads)  # libraries loaded, threads tried
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
    """Runs child() in a fresh process."""
    words = [sys.executable, __file__, *map(str, case), str(threads)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


if __name__ == "__main__":
    print(json.dumps(child(sys.argv[1], *map(int, sys.argv[2:5]))))
