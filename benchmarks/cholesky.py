# SPDX-License-Identifier: GPL-3.0-or-later
"""Our solver against sparse Cholesky on the very same system (cholesky.cpp): CHOLMOD, and Eigen's
SimplicialLDLT.

CHOLMOD's speed is that of the BLAS it finds at run time: Debian's reference BLAS is several times
slower than OpenBLAS (package libopenblas0-pthread). Which one it was is written beside the figures.
Set BENCH_LDLT=1 for Eigen's LDLT at 800 K triangles as well: it takes minutes there.
"""

import ctypes.util
import json
import os
import statistics
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import control_meshes
import numpy as np
import table

PROGRAM = (
    Path(__file__).resolve().parent.parent
    / "build"
    / "bench"
    / "benchmarks"
    / "fairing_bench_cholesky"
)
TARGETS = {50: 3, 800: 10}  # thousands of triangles -> times faster than CHOLMOD
CASES = [
    ("50 K triangles, L = 3", control_meshes.sphere, 6, 3, 7, True),
    ("50 K triangles, L = 5", control_meshes.sphere, 2, 5, 7, True),
    ("50 K as quads, L = 3", control_meshes.quad_sphere, 8, 3, 7, True),
    ("200 K triangles, L = 3", control_meshes.sphere, 12, 3, 3, True),
    ("200 K as quads, L = 3", control_meshes.quad_sphere, 16, 3, 3, True),
    ("800 K triangles, L = 3", control_meshes.sphere, 25, 3, 2, False),
    ("800 K triangles, L = 6", control_meshes.sphere, 3, 6, 2, False),
    ("800 K as quads, L = 3", control_meshes.quad_sphere, 32, 3, 2, False),
]


def write_mesh(mesh: tuple[np.ndarray, np.ndarray], path: Path) -> None:
    """The program's plain text form."""
    vertices, faces = mesh
    lines = [f"{len(vertices)} {len(faces)}"]
    lines += [" ".join(map(repr, p)) for p in vertices.tolist()]
    lines += [" ".join(map(str, [len(f), *f])) for f in faces.tolist()]
    path.write_text("\n".join(lines) + "\n")


def blas() -> str:
    """The BLAS that CHOLMOD loads."""
    listing = subprocess.run(["ldd", str(PROGRAM)], capture_output=True, text=True).stdout
    paths = [
        line.split("=>")[1].split("(")[0].strip()
        for line in listing.splitlines()
        if "libblas" in line
    ]
    if not paths:
        return ctypes.util.find_library("blas") or "unknown"
    resolved = str(Path(paths[0]).resolve())
    return (
        "OpenBLAS"
        if "openblas" in resolved
        else "BLIS"
        if "blis" in resolved
        else f"reference ({Path(resolved).name})"
    )


def race(mesh: Path, levels: int, threads: int, repeats: int, ldlt: bool) -> dict[str, Any]:
    """One run of the program: all its repeats in one process."""
    words = [str(PROGRAM), str(mesh), str(levels), str(threads), str(repeats)] + (
        ["ldlt"] if ldlt else []
    )
    environment = {**os.environ}
    if threads:
        environment["OPENBLAS_NUM_THREADS"] = environment["OMP_NUM_THREADS"] = str(threads)
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        raise SystemExit(f"{PROGRAM.name}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def middle(times: dict[str, list[float]], clock: str) -> float:
    """The median, or NaN where nothing ran."""
    return statistics.median(times[clock]) if times[clock] else float("nan")


def run() -> dict[str, Any]:
    """All cases, on one thread and on all."""
    result: dict[str, Any] = {"blas": blas()}
    rows = []
    for threads in (1, 0):
        for name, make, size, levels, repeats, small in CASES:
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "mesh.txt"
                write_mesh(make(size), path)
                ldlt = small or os.environ.get("BENCH_LDLT") == "1"
                entry = race(path, levels, threads, repeats, ldlt and threads == 1)
            result[f"{name}, threads {threads or 'all'}"] = entry
            ours, cholmod = (middle(entry[k], "wall") for k in ("ours", "cholmod"))
            ours_cpu, cholmod_cpu = (middle(entry[k], "processor") for k in ("ours", "cholmod"))
            rows.append(
                [
                    name,
                    threads or "all",
                    ours,
                    ours_cpu,
                    cholmod,
                    cholmod_cpu,
                    cholmod / ours,
                    cholmod_cpu / ours_cpu,
                    middle(entry["ldlt"], "wall") / ours,
                    middle(entry["assembly"], "wall"),
                    f"{entry['cholmod_distance']:.0e}",
                ]
            )
    table.show(
        f"Seconds to the solution, CHOLMOD on {result['blas']} (targets: "
        + ", ".join(f"{t} × at {k} K" for k, t in TARGETS.items())
        + ")",
        [
            "mesh",
            "threads",
            "ours",
            "processor",
            "CHOLMOD",
            "processor",
            "ratio",
            "by processor",
            "LDLT ratio",
            "assembly",
            "apart by",
        ],
        rows,
    )
    return result
