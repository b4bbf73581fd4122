# SPDX-License-Identifier: GPL-3.0-or-later
"""The same job by us and by other programs: a control mesh refined, its vertices fixed, all others
faired.

Two kinds of peers. Those that solve the very same system: CHOLMOD, and Eigen's LDLT where it is
small (cholesky.cpp); their time is from the assembled matrix to the solution, the assembly apart.
And those that fair in their own way: CGAL and libigl by their own bi-Laplacians, on a mesh that has
been refined for them beforehand; Manifold by patches, for which nothing is solved. Ours is
everything, from plain arrays to plain arrays.

A process for each; one that takes more than LIMIT seconds is ended, and left out at the larger
sizes.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cholesky
import control_meshes
import numpy as np
import table

LIMIT = 60  # seconds a run
REPEATS = {46_080: 7, 81_920: 7, 184_320: 5, 800_000: 3}
CASES = {
    "46 K, 720 faces": (6, 3),
    "82 K, 320 faces": (4, 4),
    "184 K, 2,880 faces": (12, 3),
    "800 K, 12,500 faces": (25, 3),
}
THREADS = {1: ", one thread", 2: ", two"}
LARGEST_FOR_LDLT = 50_000
TOLERANCE = 1e-6
CGAL = cholesky.PROGRAM.with_name("fairing_bench_cgal")


def refined(
    points: np.ndarray, triangles: np.ndarray, levels: int
) -> tuple[np.ndarray, np.ndarray]:
    """Refines flat faces 1-to-4 `levels` times; the control vertices stay first."""
    for _ in range(levels):
        sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, place = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = triangles.T
        ab, bc, ca = (len(points) + place.reshape(-1, 3)).T
        points = np.concatenate([points, points[edges].mean(axis=1)])
        pieces = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = np.concatenate([np.stack(piece, axis=1) for piece in pieces])
    return points, triangles


def timed(body: Callable[[], Any], repeats: int) -> dict[str, Any]:
    """Wall seconds of each run, after a first run that is not counted."""
    body()
    wall = []
    for _ in range(repeats):
        start = time.perf_counter()
        last = body()
        wall.append(time.perf_counter() - start)
    return {"wall": wall, **(last if isinstance(last, dict) else {})}


def ours(size: int, levels: int, repeats: int, threads: int) -> dict[str, Any]:
    """Our time from arrays to arrays."""
    import discrete_fairing as df

    mesh = control_meshes.sphere(size)

    def body() -> dict[str, Any]:
        report = df.fair(
            *mesh, levels=levels, relative_residual=TOLERANCE, measure=False, threads=threads
        ).report
        return {"iterations": [level["iterations"] for level in report["levels"]]}

    return timed(body, repeats)


def defaults(size: int, levels: int, repeats: int, threads: int) -> dict[str, Any]:
    """Our time from arrays to arrays with default settings: on pads, to visible accuracy."""
    import discrete_fairing as df

    mesh = control_meshes.sphere(size)
    df.fair(*mesh, levels=1, threads=threads)  # libraries loaded

    def body() -> dict[str, Any]:
        report = df.fair(*mesh, levels=levels, threads=threads).report
        return {"iterations": [level["iterations"] for level in report["levels"]]}

    return timed(body, repeats)


def libigl(size: int, levels: int, repeats: int) -> dict[str, Any]:
    """libigl's harmonic with k = 2: cotangent Laplacian, lumped mass, min_quad_with_fixed on Eigen's LDLT."""
    import rivals

    igl = rivals.installed("igl", "libigl")
    vertices, faces = control_meshes.sphere(size)
    points, triangles = refined(vertices, faces, levels)
    fixed = np.arange(len(vertices))
    return timed(lambda: igl.harmonic(points, triangles, fixed, vertices, 2), repeats)


def manifold(size: int, levels: int, repeats: int) -> dict[str, Any]:
    """Manifold's smooth, then refine; from arrays to arrays."""
    import rivals

    rivals.installed("manifold3d", "manifold3d")
    vertices, faces = control_meshes.sphere(size)
    return timed(lambda: rivals.manifold(vertices, faces.tolist(), levels), repeats)


CHILDREN = {
    "ours": ours,
    "defaults": defaults,
    "libigl": libigl,
    "manifold": manifold,
}


def finished(words: list[str], repeats: int, **variables: str) -> dict[str, Any]:
    """The output of a program; a note if it takes too long or fails."""
    try:
        done = subprocess.run(
            words,
            capture_output=True,
            text=True,
            env={**os.environ, **variables},
            timeout=LIMIT * (repeats + 1),
        )
    except subprocess.TimeoutExpired:
        return {"note": f"over {LIMIT} s"}
    if done.returncode:
        return {"note": (done.stderr.strip().splitlines() or ["failed"])[-1]}
    return json.loads(done.stdout.splitlines()[-1])


def child(name: str, case: tuple[int, int], repeats: int, *more: int) -> dict[str, Any]:
    """Runs one of the Python programs in a process of its own."""
    words = [sys.executable, __file__, name, *map(str, (*case, repeats, *more))]
    return finished(words, repeats)


def cgal(case: tuple[int, int], repeats: int) -> dict[str, Any]:
    """Runs cgal.cpp on the refined mesh."""
    vertices, faces = control_meshes.sphere(case[0])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.txt"
        cholesky.write_mesh(refined(vertices, faces, case[1]), path)
        return finished([str(CGAL), str(path), str(len(vertices)), str(repeats)], repeats)


def same_system(case: tuple[int, int], repeats: int, threads: int, ldlt: bool) -> dict[str, Any]:
    """Runs cholesky.cpp: CHOLMOD, its analysis alone, assembly, LDLT."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.txt"
        cholesky.write_mesh(control_meshes.sphere(case[0]), path)
        words = [str(cholesky.PROGRAM), str(path), str(case[1]), str(threads), str(repeats)]
        count = str(threads)
        return finished(
            words + ["ldlt"] * ldlt, 3 * repeats, OPENBLAS_NUM_THREADS=count, OMP_NUM_THREADS=count
        )


def measure(case: tuple[int, int], slow: set[str]) -> dict[str, Any]:
    """Times all competitors on one mesh, except those in `slow`."""
    triangles = 20 * case[0] ** 2 * 4 ** case[1]
    repeats = REPEATS[triangles]
    found: dict[str, Any] = {}
    for threads, on in THREADS.items():
        found[f"ours{on}"] = child("ours", case, repeats, threads)
        found[f"ours, default settings{on}"] = child("defaults", case, repeats, threads)
        entry = same_system(case, repeats, threads, threads == 1 and triangles <= LARGEST_FOR_LDLT)
        if "note" in entry:
            found[f"CHOLMOD{on}"] = entry
            continue
        whole, analysis = entry["cholmod"]["wall"], entry["analysis"]["wall"]
        found[f"CHOLMOD{on}"] = {"wall": whole}
        found[f"CHOLMOD without analysis{on}"] = {"wall": [a - b for a, b in zip(whole, analysis)]}
        if threads == 1:
            found["(assembly of its matrix)"] = entry["assembly"]
        if entry["ldlt"]["wall"]:
            found["Eigen SimplicialLDLT"] = entry["ldlt"]
    others = {
        "CGAL fair": lambda: cgal(case, min(2, repeats)),
        "libigl harmonic": lambda: child("libigl", case, min(2, repeats)),
        "manifold3d smooth": lambda: child("manifold", case, repeats),
    }
    for name, make in others.items():
        found[name] = {"note": "left out: too slow at the size before"} if name in slow else make()
    return found


def run() -> dict[str, Any]:
    """Times all sizes."""
    result: dict[str, Any] = {"blas": cholesky.blas()}
    slow: set[str] = set()
    for name, case in CASES.items():
        found = result[name] = measure(case, slow)
        for peer, entry in found.items():
            if "note" in entry:
                slow |= {peer} if "over" in entry["note"] else set()
                continue
            seconds = statistics.median(entry["wall"])
            slow |= {peer} if 4 * seconds > LIMIT else set()
    return result


def wall(result: dict[str, Any], size: str, tool: str) -> float | None:
    """The median time of a tool in `peers`; None where it took too long to be run."""
    times = result[size].get(tool, {}).get("wall")
    return statistics.median(times) if times else None


def sizes_of_peers(result: dict[str, Any]) -> list[str]:
    return [name for name, found in result.items() if isinstance(found, dict)]


def peers_table(result: dict[str, Any]) -> str:
    """The same job by other tools; in brackets the ratio to ours on one thread."""
    ours = {
        "ours, one thread": "ours, one thread",
        "ours, two threads": "ours, two",
        "ours, default settings, two threads": "ours, default settings, two",
    }
    theirs = {
        "CHOLMOD": "CHOLMOD, one thread",
        "CHOLMOD, analysis kept": "CHOLMOD without analysis, one thread",
        "Eigen LDLT": "Eigen SimplicialLDLT",
        "CGAL": "CGAL fair",
        "libigl": "libigl harmonic",
        "Manifold": "manifold3d smooth",
    }
    sizes = sizes_of_peers(result)
    rows = []
    for label, tool in {**ours, **theirs}.items():
        row = [label]
        for size in sizes:
            time, unit = wall(result, size, tool), wall(result, size, "ours, one thread")
            assert unit
            ratio = f" ({table.short(time / unit)})" if time and label in theirs else ""
            row.append(f"{table.short(time)}{ratio}" if time else "–")
        rows.append(row)
    heads = [
        size.replace(",", " triangles,", 1).replace("faces", "control faces") for size in sizes
    ]
    return table.markdown(["seconds", *heads], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "peers": peers_table(result),
    }


if __name__ == "__main__":
    print(json.dumps(CHILDREN[sys.argv[1]](*map(int, sys.argv[2:]))))
