# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces in pieces: memory, seconds and bytes on disk against size; two workers against one; and
the difference to the whole against the rings around each piece.

Planner, worker and judge are processes of their own, so that each peak of resident memory is its
own. `python benchmarks/piecewise.py size 391680 40 FOLDER` runs one size alone.
"""

from __future__ import annotations

import json
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import table

LEVELS = 5  # a control triangle becomes 1024
RESIDUAL = 1e-6
FACES_A_PIECE = 10_000
SIZES = (1_000, 10_000, 50_000)  # control triangles; 391,680 are 400 million, for half an hour
RINGS = (1, 2, 3, 4, 5, 6, 8, 10)


def lumpy_torus(triangles: int) -> tuple[Any, Any]:
    """A torus with lumps on its lumps, of about so many control triangles."""
    import numpy as np

    around = max(8, round((triangles * 1.05) ** 0.5))
    across = max(6, round(triangles / 2 / around))
    u, w = np.meshgrid(
        np.arange(around) * 2 * np.pi / around,
        np.arange(across) * 2 * np.pi / across,
        indexing="ij",
    )
    radius = 0.7 + 0.05 * np.sin(5 * u) * np.sin(3 * w) + 0.008 * np.sin(31 * u + 17 * w)
    points = np.stack(
        [
            (2 + radius * np.cos(w)) * np.cos(u),
            (2 + radius * np.cos(w)) * np.sin(u),
            radius * np.sin(w),
        ],
        -1,
    ).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")

    def at(i: Any, j: Any) -> Any:
        return (i % around) * across + j % across

    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return points, np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)


def used() -> dict[str, float]:
    import one_run

    spent = resource.getrusage(resource.RUSAGE_SELF)
    return {
        "resident_bytes": one_run.peak_resident_bytes(),
        "processor": spent.ru_utime + spent.ru_stime,
    }


def plan(triangles: int, count: int, folder: Path) -> dict[str, Any]:
    import discrete_fairing as df

    begun = time.perf_counter()
    mesh = lumpy_torus(triangles)
    for piece in df.pieces(*mesh, LEVELS, count=count, relative_residual=RESIDUAL):
        piece.save(folder / f"piece-{piece.index:05}.npz")
    return {"control_triangles": len(mesh[1]), "wall": time.perf_counter() - begun, **used()}


def fair_file(path: Path, threads: int = 0) -> dict[str, Any]:
    """Runs a worker: reads one piece from disk, and writes its part to disk in single precision."""
    import discrete_fairing as df

    part = df.Piece.load(path).fair(threads=threads)
    part.save(path.with_name(path.name.replace("piece", "part")), dtype="float32")
    return {"iterations": part.report["iterations"], "peak_bytes": part.report["peak_bytes"]}


def work(folder: Path) -> dict[str, Any]:
    begun = time.perf_counter()
    told = [fair_file(path) for path in sorted(folder.glob("piece-*.npz"))]
    return {
        "wall": time.perf_counter() - begun,
        "iterations": max(entry["iterations"][-1] for entry in told),
        "peak_bytes": max(entry["peak_bytes"] for entry in told),
        **used(),
    }


def judge(folder: Path) -> dict[str, Any]:
    import discrete_fairing as df

    begun = time.perf_counter()
    jump = df.largest_jump(sorted(folder.glob("part-*.npz")))
    return {"jump": jump, "wall": time.perf_counter() - begun, **used()}


STEPS = {"plan": plan, "work": work, "judge": judge}


def alone(step: str, *words: Any) -> dict[str, Any]:
    """Runs a step in a process of its own."""
    done = subprocess.run(
        [sys.executable, __file__, step, *map(str, words)],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


def size(triangles: int, count: int, folder: Path) -> dict[str, Any]:
    folder.mkdir(parents=True, exist_ok=True)
    planned = alone("plan", triangles, count, folder)
    worked = alone("work", folder)
    judged = alone("judge", folder)
    return {
        "triangles": planned["control_triangles"] << (2 * LEVELS),
        "pieces": len(list(folder.glob("piece-*.npz"))),
        "plan": planned,
        "work": worked,
        "judge": judged,
        "bytes_of_pieces": sum(path.stat().st_size for path in folder.glob("piece-*.npz")),
        "bytes_of_parts": sum(path.stat().st_size for path in folder.glob("part-*.npz")),
    }


def two_workers(triangles: int, count: int) -> dict[str, Any]:
    """Seconds of one worker process and of two, one thread each, in turns."""
    from dask.distributed import Client, LocalCluster

    out: dict[str, Any] = {"pieces": count, "walls": {}}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        plan(triangles, count, folder)
        paths = sorted(folder.glob("piece-*.npz"))
        for workers in (1, 2, 1, 2):
            with (
                LocalCluster(
                    n_workers=workers, threads_per_worker=1, dashboard_address=None
                ) as cluster,
                Client(cluster) as client,
            ):
                client.run(lambda: __import__("discrete_fairing"))
                begun = time.perf_counter()
                client.gather(client.map(fair_file, paths, threads=1, pure=False))
                out["walls"].setdefault(workers, []).append(time.perf_counter() - begun)
    best = {workers: min(walls) for workers, walls in out["walls"].items()}
    out["efficiency"] = best[1] / best[2] / 2
    return out


def meshes() -> dict[str, tuple[Any, Any]]:
    import control_meshes

    return {
        "torus, triangles": lumpy_torus(2000),
        "sphere, quads": control_meshes.quad_sphere(14, 0.0),
        "rough sphere": control_meshes.sphere(12, 0.15),
    }


def rings(
    energies: tuple[str, ...] = ("thin_plate", "total_curvature", "minimum_variation"),
) -> list[dict[str, Any]]:
    """The largest difference from the whole, as a share of its size, for four pieces and L = 2."""
    import discrete_fairing as df
    import numpy as np

    out = []
    for energy in energies:
        settings: dict[str, Any] = {"energy": energy, "relative_residual": 1e-10}
        if energy != "thin_plate":
            settings |= {"step_tolerance": 1e-9, "relative_residual": 1e-8}
        for name, (points, faces) in meshes().items():
            whole = df.fair(points, faces, 2, **settings)
            for around in RINGS:
                parts = [
                    piece.fair()
                    for piece in df.pieces(points, faces, 2, count=4, rings=around, **settings)
                ]
                joined = df.join(parts)
                gap = np.linalg.norm(joined.vertices - whole.vertices, axis=1).max()
                out.append(
                    {
                        "energy": energy,
                        "mesh": name,
                        "rings": around,
                        "difference": float(gap / np.ptp(points, axis=0).max()),
                        "jump": joined.report["pieces"]["jump"]["share"],
                    }
                )
    return out


def run() -> dict[str, Any]:
    result: dict[str, Any] = {"sizes": [], "rings": rings()}
    for triangles in SIZES:
        folder = Path(tempfile.mkdtemp())
        try:
            result["sizes"].append(size(triangles, -(-triangles // FACES_A_PIECE), folder))
        finally:
            shutil.rmtree(folder)
    result["two_workers"] = two_workers(10_000, 8)
    print(f"Two workers: efficiency {result['two_workers']['efficiency']:.2f}")
    return result


def pieces_table(result: dict[str, Any]) -> str:
    """Surfaces made in pieces, by their size."""
    heads = ["triangles", "pieces", "a worker's peak, all its memory"]
    heads += ["wall time", "CPU time", "on disk", "largest jump / size"]
    rows = []
    for s in result["sizes"]:
        work, share = s["work"], s["judge"]["jump"]["share"]
        row = [f"{s['triangles'] / 1e6:.3g} million", str(s["pieces"])]
        row += [f"{work['resident_bytes'] / 1e6:,.0f} MB"]
        row += [
            f"{work[clock]:,.3g} s" if work[clock] < 1000 else f"{work[clock]:,.0f} s"
            for clock in ("wall", "processor")
        ]
        rows.append(
            [*row, f"{s['bytes_of_parts'] / 1e6:,.0f} MB", table.short(share) if share else "–"]
        )
    return table.markdown(heads, rows)


def rings_table(result: dict[str, Any]) -> str:
    """Differences of pieces from the whole, by rings."""
    found = result["rings"]
    rings = sorted({r["rings"] for r in found})
    rows: dict[str, list[str]] = {}
    for r in found:
        name = f"{r['energy'].replace('_', ' ')}, {r['mesh']}"
        rows.setdefault(name, []).append(f"{r['difference']:.1e}".replace("e-0", "e-"))
    heads = ["rings", *(str(r) for r in rings)]
    return table.markdown(heads, [[name, *cells] for name, cells in rows.items()])


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "pieces": pieces_table(result),
        "pieces.rings": rings_table(result),
    }


if __name__ == "__main__":
    step, *words = sys.argv[1:]
    numbers = [int(word) for word in words if word.isdigit()]
    folders = [Path(word) for word in words if not word.isdigit()]
    call = {"size": size, **STEPS}[step]
    print(json.dumps(call(*numbers, *folders)))
