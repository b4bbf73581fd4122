# SPDX-License-Identifier: GPL-3.0-or-later
"""Pads on meshes that are hard for them: bevelled boxes, thin plates, slivers, stars, and on clean
ones, each beside the same surface on point forces.

    .venv/bin/python benchmarks/bevels.py [FAMILY …]

runs this alone; families may be cut short. Everything is measured in NumPy
(tests/python/surface_judge.py); clean meshes are those of the collection that may lie beside the
project and small ones of the tests, and for them alone curvature peaks are counted.
"""

import sys
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import curvature_peaks
import discrete_fairing as df
import from_tests
import numpy as np
import table
import timing

SIZES = (1.0, 0.7, 0.5, 0.0)  # the last one is what the others are measured against
LEVELS, FEWER, MANY = 3, 2, 600  # clean meshes: levels; those of meshes with more faces
MOST = 3000  # faces of a clean mesh
BOX_LEVELS, THIN_LEVELS = (1, 2, 3), 2
SWOLLEN = 1.02  # of the extent on point forces
WORST = 12
HEADS = ("family", "pad size", "meshes", "refused", "converged", "warned")
HEADS += ("extent over points': largest", "swollen", "E over points': median", "95 %", "largest")
HEADS += ("angle over points': median", "95 %", "largest", "folded", "iterations", "processor, s")

Case = tuple[str, str, np.ndarray, Any, int]


def boxes() -> Iterator[Case]:
    """Family, name, vertices, faces, levels."""
    bevelled_boxes, _ = from_tests.hard_meshes()
    for levels in BOX_LEVELS:
        for name, (sides, bevel) in bevelled_boxes.family().items():
            mesh = bevelled_boxes.bevelled_box(sides, bevel)
            yield f"boxes, L = {levels}", f"{name}, L = {levels}", *mesh, levels


def thin() -> Iterator[Case]:
    """The same."""
    _, thin_meshes = from_tests.hard_meshes()
    for mesh in thin_meshes.meshes():
        yield *mesh, THIN_LEVELS


def clean() -> Iterator[Case]:
    """The same: whatever needs no mending and is curved."""
    mesh_files, shared_data = from_tests.readers()
    good = shared_data.SHARED / "good"
    paths = sorted(p for p in good.rglob("*") if p.suffix.lower() in mesh_files.SUFFIXES)
    found = [(str(p.relative_to(good).with_suffix("")), mesh_files.read_mesh(p)) for p in paths]
    small = from_tests.small_meshes().ALL
    found += [(name, make()) for name, make in small.items() if name != "grid"]
    for name, (vertices, faces) in found:
        if len(faces) <= MOST:
            levels = FEWER if len(faces) > MANY else LEVELS
            yield "clean", name.split("__")[-1], np.asarray(vertices, float), faces, levels


def cases(wanted: list[str]) -> Iterator[Case]:
    """Those of families that begin with one of these."""
    for case in (*boxes(), *thin(), *clean()):
        if not wanted or any(case[0].startswith(name) for name in wanted):
            yield case


def one(case: Case, size: float) -> dict[str, Any]:
    """The figures of one surface; of a refused mesh, the code."""
    family, _, vertices, faces, levels = case
    try:
        result, _, seconds = timing.measured(
            lambda: df.fair(vertices, faces, levels, pad_size=size, threads=1, measure=False)
        )
    except df.FairingError as error:
        return {"refused": error.code}
    report = result.report
    entry = asdict(from_tests.judge.judge(vertices, faces, result))
    entry |= {
        "converged": bool(report["converged"]),
        "warnings": len(report.get("warnings", ())),
        "iterations": int(sum(report["iterations"])),
        "seconds": seconds,
    }
    if family == "clean":
        triangles = result.triangles.astype(np.int64)
        found = curvature_peaks.ratios(result.vertices, triangles, len(vertices))
        entry["peaks"] = curvature_peaks.summary(found)["over_mean"] if len(found) else None
    return entry


def beside(entry: dict[str, Any], points: dict[str, Any], figure: str) -> float:
    """A figure over that on point forces; 1 where both are nothing."""
    if points[figure] > 1e-9:
        return entry[figure] / points[figure]
    return 1.0 if entry[figure] <= 1e-9 else float("inf")


def three(values: list[float]) -> list[float]:
    """Median, 95 % and the largest."""
    return [float(np.quantile(values, q, method="nearest")) for q in (0.5, 0.95, 1)]


def swollen(entry: dict[str, Any], points: dict[str, Any]) -> float:
    """The extent over the point forces', or over the control mesh's where that is nearer."""
    return entry["extent"] / max(1.0, points["extent"])


def row(family: str, size: float, pairs: list[tuple[dict, dict]]) -> list[Any]:
    """A line of the table, from the figures of all meshes and those on point forces."""
    taken = [(entry, points) for entry, points in pairs if "refused" not in entry | points]
    extents = [beside(entry, points, "extent") for entry, points in taken]
    angle = three([beside(entry, points, "angle") for entry, points in taken])
    return [
        family,
        size,
        len(pairs),
        len(pairs) - len(taken),
        sum(entry["converged"] for entry, _ in taken),
        sum(entry["warnings"] > 0 for entry, _ in taken),
        f"{max(extents):.4g}",
        sum(swollen(entry, points) > SWOLLEN for entry, points in taken),
        *three([beside(entry, points, "energy") for entry, points in taken]),
        *angle,
        sum(entry["folds"] > 0 for entry, _ in taken),
        sum(entry["iterations"] for entry, _ in taken),
        f"{sum(entry['seconds'] for entry, _ in taken):.2f}",
    ]


def show_peaks(result: dict[str, dict[str, dict]]) -> None:
    """Of the clean meshes, curvature at control vertices over their ring's mean."""
    rows = []
    for size in map(str, SIZES):
        peaks = [m[size]["peaks"] for m in result.get("clean", {}).values() if m[size].get("peaks")]
        if peaks:
            over = sum(peak[2] > curvature_peaks.PEAK for peak in peaks)
            rows.append([size, len(peaks), *three([peak[2] for peak in peaks]), over])
    if rows:
        heads = ["pad size", "meshes", "largest peak of a mesh: median", "95 %", "largest"]
        table.show("Peaks on clean meshes", [*heads, f"over {curvature_peaks.PEAK}"], rows)


def show_worst(result: dict[str, dict[str, dict]]) -> None:
    """The meshes whose surface swells most on pads of any width."""
    found = []
    for meshes in result.values():
        for name, by_size in meshes.items():
            points = by_size[str(SIZES[-1])]
            for size in map(str, SIZES[:-1]):
                if "refused" not in by_size[size] | points:
                    entry = by_size[size]
                    ratios = [beside(entry, points, key) for key in ("extent", "energy", "angle")]
                    found.append([name, size, *ratios, entry["converged"], entry["iterations"]])
    for column, what in ((2, "extent"), (3, "energy")):
        rows = sorted(found, key=lambda line: -line[column])[:WORST]
        heads = ["mesh", "pad size", "extent", "E", "angle", "converged", "iterations"]
        table.show(f"Worst by {what} over the point forces'", heads, rows)


def run(wanted: list[str] | None = None) -> dict[str, Any]:
    """All families, and what each mesh gives by pad size."""
    result: dict[str, dict[str, dict]] = {}
    for case in cases(wanted or []):
        entry = {str(size): one(case, size) for size in SIZES}
        result.setdefault(case[0], {})[case[1]] = entry
    rows = []
    for family, meshes in result.items():
        for size in SIZES:
            pairs = [(m[str(size)], m[str(SIZES[-1])]) for m in meshes.values()]
            rows.append(row(family, size, pairs))
    table.show("Thin plate on pads, over point forces", HEADS, rows)
    show_peaks(result)
    show_worst(result)
    return result


if __name__ == "__main__":
    run(sys.argv[1:])
