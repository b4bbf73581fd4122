# SPDX-License-Identifier: GPL-3.0-or-later
"""Total curvature on every mesh of the collection that may lie beside the project: what it reaches,
and how soon. Meshes that are not clean are mended first.

Energies of the thin plate's and of its own surface as the core measures them, and these with the
butterfly's by surface_measures.py, which is independent of it. Where creases are listed beside a
mesh it is run with them as well, and measured by the core alone: it knows where the creases are.
"""

import statistics
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import rivals
import self_intersections
import table
from from_tests import measures

LEVELS, FEWER, MANY = 3, 2, 600  # levels; those of meshes with more faces
DECREMENT = (
    1e-3**0.5
)  # converged: the squared decrement, a share of the energy, is below a thousandth
STEPS, ITERATIONS = 10, 40  # at most
SHARP = 90.0  # degrees; on creases there may be such angles by right
HEADS = (
    "faces",
    "L",
    "thin plate",
    "total",
    "thin plate, measured",
    "total, measured",
    "butterfly, measured",
)
HEADS += (
    "steps to 1e-3",
    "steps",
    "λ²",
    "iterations",
    "mended",
    "folds",
    "crossing",
    "angles > 90°",
)
HEADS += ("µs", "short of")
SLOWEST = 10
SLOW_HEADS = ("µs", "times median", "hierarchy", "solve", "steps", "corrections", "iterations")


def cases() -> Iterator[tuple[str, np.ndarray, list[list[int]], dict[str, Any]]]:
    """Name, vertices, polygons, options."""
    mesh_files, shared_data = from_tests.readers()
    for folder in (shared_data.SHARED / "good", shared_data.SHARED / "bad"):
        mending = {"repair": "mend"} if folder.name == "bad" else {}
        for path in sorted(p for p in folder.rglob("*") if p.suffix.lower() in mesh_files.SUFFIXES):
            name = str(path.relative_to(folder).with_suffix(""))
            try:
                vertices, faces = mesh_files.read_mesh(path)
            except ValueError as error:
                print(f"clean: {error}")
                continue
            yield name, vertices, faces, mending
            creases = listed_creases(path, faces, shared_data)
            if creases:
                yield f"{name}, creases", vertices, faces, creases | mending


def listed_creases(path: Path, faces: list[list[int]], shared_data: Any) -> dict[str, Any]:
    """As options; some lists name an edge of a face that the file does not have."""
    edges, corners = shared_data.creases_of(path, sharper_than=2.0)
    there = {frozenset(e) for f in faces for e in zip(f, [*f[1:], *f[:1]])}
    edges = [e for e in edges.tolist() if frozenset(e) in there]
    return {"crease_edges": edges, "corner_vertices": corners} if len(edges) + len(corners) else {}


def butterfly(vertices: np.ndarray, faces: list[list[int]], levels: int) -> float | None:
    """The measured energy of the butterfly's surface, where there is one."""
    try:
        return measures.total_curvature(*rivals.modified_butterfly(vertices, faces, levels))
    except rivals.Refused:
        return None


def arrays(result: df.Result) -> rivals.Surface:
    """The surface as triangles."""
    return result.vertices, result.triangles.astype(np.int64)


def measured(result: df.Result) -> float:
    """Its total curvature, measured without the core."""
    return measures.total_curvature(*arrays(result))


def one(vertices: np.ndarray, faces: list[list[int]], options: dict[str, Any]) -> dict[str, Any]:
    """The figures of one mesh."""
    levels = FEWER if len(faces) > MANY else LEVELS
    plate = df.fair(vertices, faces, levels=levels, measure=False, **options)
    start = time.process_time()
    result = df.fair(
        vertices,
        faces,
        levels=levels,
        energy="total_curvature",
        measure=False,
        threads=1,
        **options,
    )
    seconds = time.process_time() - start
    entries = result.report["curvature"]
    steps = entries[-1]["steps"]
    near = [k for k, step in enumerate(steps, 1) if step["decrement"] <= DECREMENT]
    return {
        "faces": len(faces),
        "levels": levels,
        "plate": entries[-1]["plate_energy"],
        "energy": entries[-1]["energy"],
        "plate_measured": None if options else measured(plate),
        "energy_measured": None if options else measured(result),
        "butterfly": None if options else butterfly(vertices, faces, levels),
        "steps_to_convergence": near[0] if near else None,
        "steps": len(steps),
        "decrement": steps[-1]["decrement"] if steps else 0.0,
        "iterations": [max((s["iterations"] for s in e["steps"]), default=0) for e in entries],
        "finite": bool(np.isfinite(result.vertices).all()),
        "folds": entries[-1]["folds"],  # where the control mesh is not folded itself
        "crossing": self_intersections.crossing_triangles(*arrays(result)),
        "sharp": int((measures.dihedrals(*arrays(result)) > SHARP).sum()),
        "mended": sum(len(repair["elements"]) for repair in result.report["repairs"]),
        "microseconds": 1e6 * seconds / len(result.triangles),
        "seconds": result.report["seconds"],
        "steps_of_levels": [len(e["steps"]) for e in entries],
        "corrections": [sum(s["pad_corrections"] for s in e["steps"]) for e in entries],
    }


def shortfalls(entry: dict[str, Any]) -> list[str]:
    """What of the demands is not met; folds are counted only."""
    over_butterfly = (
        entry["butterfly"] is not None and entry["energy_measured"] > entry["butterfly"]
    )
    iterated = [n for n in entry["iterations"] if n]  # 0: solved directly
    missed = {
        "finite": not entry["finite"],
        "thin plate": entry["energy"] > entry["plate"] * (1 + 1e-12),
        "butterfly": over_butterfly,
        "steps": not 0 < (entry["steps_to_convergence"] or 0) <= STEPS and entry["steps"] > 0,
        "iterations": max(entry["iterations"], default=0) > ITERATIONS,
        "growth": len(iterated) > 1 and iterated[-1] > 1.5 * iterated[-2] + 2,
    }
    return [name for name, short in missed.items() if short]


def row(name: str, entry: dict[str, Any]) -> list[Any]:
    """The table's cells."""
    energies = ("plate", "energy", "plate_measured", "energy_measured", "butterfly")
    return [
        name,
        entry["faces"],
        entry["levels"],
        *("" if entry[k] is None else f"{entry[k]:.6g}" for k in energies),
        entry["steps_to_convergence"] or "never",
        entry["steps"],
        f"{entry['decrement'] ** 2:.0e}",
        " ".join(str(n or "d") for n in entry["iterations"]),
        entry["mended"],
        entry["folds"],
        entry["crossing"],
        entry["sharp"],
        entry["microseconds"],
        ", ".join(shortfalls(entry)),
    ]


def show_slowest(result: dict[str, Any]) -> None:
    """By processor time a triangle, and where it went: shares of the run's phases."""
    median = statistics.median(entry["microseconds"] for entry in result.values())
    rows = []
    for name in sorted(result, key=lambda n: -result[n]["microseconds"])[:SLOWEST]:
        entry = result[name]
        total = sum(entry["seconds"].values())
        rows.append(
            [
                name,
                entry["microseconds"],
                entry["microseconds"] / median,
                *(entry["seconds"][phase] / total for phase in ("hierarchy", "solve")),
                " ".join(map(str, entry["steps_of_levels"])),
                " ".join(map(str, entry["corrections"])),
                " ".join(str(n or "d") for n in entry["iterations"]),
            ]
        )
    table.show(
        f"The slowest a triangle; the median takes {median:.2g} µs", ["mesh", *SLOW_HEADS], rows
    )


def show_summary(result: dict[str, Any], refused: Counter[str]) -> None:
    """How many of what."""
    short = [name for name, entry in result.items() if entry["short_of"]]
    counts = {
        "refused": refused.total(),
        "mended": sum(entry["mended"] > 0 for entry in result.values()),
        "with folds": sum(entry["folds"] > 0 for entry in result.values()),
        "that cross themselves": sum(entry["crossing"] > 0 for entry in result.values()),
    }
    print(f"{len(result)} runs; short of something: {', '.join(short) or 'none'}")
    print(", ".join(f"{what}: {count}" for what, count in counts.items()), dict(refused))


def run() -> dict[str, Any]:
    """The whole collection; nothing where it is absent."""
    result, rows, refused = {}, [], Counter()
    for name, vertices, faces, options in cases():
        try:
            entry = one(vertices, faces, options)
        except df.FairingError as error:
            print(f"clean: {name} is refused, {error.code}")
            refused[error.code] += 1
            continue
        result[name] = entry | {"short_of": shortfalls(entry)}
        rows.append(row(name, entry))
    if not rows:
        print("clean: the collection of meshes is not here.")
        return {}
    table.show(
        "Total curvature on real meshes: energies as the core has them and as measured, steps, iterations a level (d: direct)",
        ["mesh", *HEADS],
        rows,
    )
    show_slowest(result)
    show_summary(result, refused)
    return result
