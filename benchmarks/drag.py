# SPDX-License-Identifier: GPL-3.0-or-later
"""A vertex moves: the time of a warm solver for the next surface, on pads and on point forces. Three vertices
in turn, twelve moves each, by a hundredth of the mesh's size; CPU time on one thread, default settings.
"""

import json
import subprocess
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import cholesky
import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import table

MESHES = {
    "50 faces, L = 5": (meshes.hull(27), 5),
    "800 faces, L = 3": (meshes.torus(20, 20), 3),
    "80 quads, L = 4": (meshes.quad_torus(10, 8), 4),
}
MOVES = 12
DIRECTION = np.array([0.3, 0.5, 0.8])


def run() -> dict[str, Any]:
    """Milliseconds and iterations of a move: the first of each vertex, and those that follow."""
    result = {
        f"{name}, {size}": _drag(*mesh, levels, size)
        for name, (mesh, levels) in MESHES.items()
        for size in (0.0, 1.0)
    }
    if cholesky.PROGRAM.exists():
        result["kept"] = {name: _kept(*mesh, levels) for name, (mesh, levels) in MESHES.items()}
    return result


def _kept(vertices: np.ndarray, faces: np.ndarray, levels: int) -> dict[str, float]:
    """CPU milliseconds of CHOLMOD on one thread, for the same system on point forces."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.txt"
        cholesky.write_mesh((vertices, faces), path)
        words = [str(cholesky.PROGRAM), str(path), str(levels), "1", "3"]
        found = json.loads(subprocess.run(words, check=True, capture_output=True).stdout)
    return {
        "whole": 1e3 * median(found["cholmod"]["processor"]),
        "kept": 1e3 * median(found["kept"]["processor"]),
    }


def _drag(vertices: np.ndarray, faces: np.ndarray, levels: int, size: float) -> dict[str, Any]:
    solver = df.Solver(vertices, faces, levels=levels, pad_size=size, threads=1, measure=False)
    solver.solve(vertices)
    step = 0.01 * np.ptp(vertices, axis=0).max() * DIRECTION
    times, iterations = [], []
    for vertex in (0, len(vertices) // 3, 2 * len(vertices) // 3):
        moved = vertices.copy()
        for _ in range(MOVES):
            moved[vertex] += step
            start = process_time()
            report = solver.solve(moved).report
            times.append(round(1e3 * (process_time() - start), 1))
            iterations.append(report["levels"][-1]["iterations"])
    is_first = [k % MOVES <= 1 for k in range(len(times))]  # the second one shows the direction
    following = [t for t, first in zip(times, is_first) if not first]
    return {
        "first": median(t for t, first in zip(times, is_first) if first),
        "following": median(following),
        "most": max(following),
        "first_iterations": max(i for i, first in zip(iterations, is_first) if first),
        "iterations": max(i for i, first in zip(iterations, is_first) if not first),
    }


def drag_table(result: dict[str, Any]) -> str:
    """Moves of a vertex by a `Solver`."""
    heads = ["control mesh, level", "pad size", "first moves", "following", "slowest of these"]
    rows = []
    for key, d in result.items():
        if key == "kept":
            continue
        name, pad = key.rsplit(", ", 1)
        first = f"{d['first']:.0f} ms, {d['first_iterations']} iterations"
        following = f"{d['following']:.1f} ms, {d['iterations']}"
        rows.append([name, f"{float(pad):.0f}", first, following, f"{d['most']:.0f} ms"])
    return table.markdown(heads, rows)


def kept_table(result: dict[str, Any]) -> str:
    """The time of CHOLMOD for the same moves."""
    heads = ["control mesh, level", "CHOLMOD, whole", "each move, factor kept"]
    rows = [
        [name, f"{d['whole']:.0f} ms", f"{d['kept']:.0f} ms"] for name, d in result["kept"].items()
    ]
    return table.markdown(heads, rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    found = {"drag": drag_table(result)}
    return found | ({"drag.kept": kept_table(result)} if "kept" in result else {})


if __name__ == "__main__":
    run()
