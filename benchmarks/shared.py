# SPDX-License-Identifier: GPL-3.0-or-later
"""Every clean mesh of the collection that may lie beside the project, at L = 3: does the solver
converge, how soon?"""

import time
from pathlib import Path
from typing import Any

import discrete_fairing as df
import from_tests
import runs
import table

LEVELS, LIMIT = 3, 40
MOST_TRIANGLES = 4_000_000  # after refinement; larger ones get fewer levels


def levels_for(faces: list[list[int]]) -> int:
    """Three levels, fewer where the result would be huge."""
    triangles = sum(len(f) - 2 for f in faces)
    level = LEVELS
    while level > 0 and triangles * 4**level > MOST_TRIANGLES:
        level -= 1
    return level


def one(path: Path, files: Any, data: Any) -> dict[str, Any]:
    """One mesh, with its creases."""
    vertices, faces = files.read_mesh(path)
    creases, corners = data.creases_of(path)
    levels = levels_for(faces)
    start = time.perf_counter()
    report = runs.fair(
        (vertices, faces),
        levels=levels,
        crease_edges=creases,
        corner_vertices=corners,
        repair="mend",
    )
    level = runs.finest(report)
    return {
        "levels": levels,
        "triangles": report["triangles"],
        "iterations": level["iterations"],
        "degree": "direct" if level["direct"] else level["smoother_degree"],
        "residual": level["residual"],
        "converged": level["converged"],
        "seconds": time.perf_counter() - start,
    }


def run() -> dict[str, Any]:
    """The whole collection; nothing where it is absent."""
    mesh_files, shared_data = from_tests.readers()
    folder = shared_data.SHARED / "good"
    if not folder.is_dir():
        print("shared: the collection of meshes is not here.")
        return {}
    result, rows = {}, []
    for path in sorted(p for p in folder.rglob("*") if p.suffix.lower() in mesh_files.SUFFIXES):
        name = str(path.relative_to(folder).with_suffix(""))
        try:
            entry = one(path, mesh_files, shared_data)
        except (df.FairingError, ValueError) as error:
            entry = {"error": getattr(error, "code", str(error)[:40])}
        result[name] = entry
        rows.append(
            [name, *(list(entry.values()) if "error" not in entry else [entry["error"], *[""] * 6])]
        )
    table.show(
        f"The shared meshes (at most {LIMIT} iterations)",
        ["mesh", "levels", "triangles", "iterations", "degree", "residual", "converged", "seconds"],
        rows,
    )
    clean = [e for e in result.values() if "error" not in e]
    over = [
        n
        for n, e in result.items()
        if "error" not in e and (e["iterations"] > LIMIT or not e["converged"])
    ]
    print(
        f"{len(clean)} meshes ran, {len(result) - len(clean)} refused; over the limit: {', '.join(over) or 'none'}"
    )
    return result
