# SPDX-License-Identifier: GPL-3.0-or-later
"""The thin plate with the defaults on meshes by how uneven they are, at the first level with over
20,000 triangles: on how many a level above the coarsest was factored, on how many the smoother took
lines, and the time a triangle.

Meshes of thin triangles that the tests make, and the collection that may lie beside the project.
Processor seconds of one thread, the least of three runs.
"""

import statistics
import time
from collections.abc import Iterator
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import table

LEAST_TRIANGLES, FIRST_LEVEL, LAST_LEVEL = 20_000, 2, 6
REPEATS = 3
# Unknowns up to which levels are solved directly as a matter of course: any, and the coarsest.
TINY, COARSEST = 1200, 6000
SHARE = 0.95  # of the faces are less thin than the figure that a mesh is sorted by
CLASSES = (5, 10, 30, np.inf)  # longest edge over height
STRETCHES = (10, 100, 1000)
HEADS = ("thinness", "meshes", "factored", "lines", "median µs", "worst µs", "worst mesh")


def synthetic() -> Iterator[tuple[str, np.ndarray, Any]]:
    """Cylinders, caps without inner vertices, stretched clouds."""
    from_tests.readers()  # puts the tests on the path
    import sliver_meshes as slivers

    hull = from_tests.small_meshes().random_hull
    yield "hull", *hull(600)
    yield "hull, large", *slivers.stretched(hull(4000), 10)
    for aspect in (10, 100):
        height = 3 * aspect * 2 * np.pi / 120
        yield f"cylinder, faces of 1 by {aspect}", *slivers.prism(120, height, rings=3)
    yield "caps in strips", *slivers.prism()
    yield "caps in fans", *slivers.prism(height=0.2, cap=slivers.rim_fan)
    for stretch in STRETCHES:
        yield f"hull, stretched by {stretch}", *slivers.stretched(hull(400), stretch)
        yield f"sheet, stretched by {stretch}", *slivers.stretched_sheet(400, stretch)
        yield f"sheet, sheared by {stretch}", *slivers.stretched_sheet(400, stretch, sheared=True)


def collection() -> Iterator[tuple[str, np.ndarray, Any]]:
    """Every clean mesh, where there are some."""
    mesh_files, shared_data = from_tests.readers()
    folder = shared_data.SHARED / "good"
    for path in sorted(p for p in folder.rglob("*") if p.suffix.lower() in mesh_files.SUFFIXES):
        yield str(path.relative_to(folder)), *mesh_files.read_mesh(path)


def thinness(vertices: np.ndarray, faces: Any) -> float:
    """The longest edge of a face over its height, for all but a few faces; polygons as fans."""
    triangles = np.array([[f[0], f[k], f[k + 1]] for f in faces for k in range(1, len(f) - 1)])
    corner = np.asarray(vertices)[triangles]
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(1)
    twice = np.linalg.norm(
        np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
    )
    return float(np.quantile(longest**2 / np.maximum(twice, 1e-300), SHARE))


def one(vertices: np.ndarray, faces: Any) -> dict[str, Any]:
    """The figures of one mesh."""
    triangles, levels = sum(len(f) - 2 for f in faces), FIRST_LEVEL
    while triangles * 4**levels < LEAST_TRIANGLES and levels < LAST_LEVEL:
        levels += 1
    seconds = []
    for _ in range(REPEATS):
        start = time.process_time()
        result = df.fair(vertices, faces, levels=levels, threads=1, measure=False)
        seconds.append(time.process_time() - start)
    reports = result.report["levels"]
    first = reports[0]["level"]
    size = triangles * 4**levels
    return {
        "triangles": size,
        "thinness": thinness(vertices, faces),
        "factored": any(
            r["direct"] and r["unknowns"] > (COARSEST if r["level"] == first else TINY)
            for r in reports
        ),
        "lines": any(r.get("lines", False) for r in reports),
        "iterations": [r["iterations"] for r in reports],
        "corrections": [r["pad_corrections"] for r in reports],
        "converged": reports[-1]["converged"],
        "microseconds": 1e6 * min(seconds) / size,
        "bytes": result.report["peak_bytes"] / size,
    }


def summarize(entries: dict[str, dict[str, Any]]) -> list[list[Any]]:
    """A row for each class of thinness."""
    rows, below = [], 0.0
    for bound in CLASSES:
        inside = {n: e for n, e in entries.items() if below <= e["thinness"] < bound}
        if inside:
            worst = max(inside, key=lambda n: inside[n]["microseconds"])
            rows.append(
                [
                    f"{below:g} to {bound:g}",
                    len(inside),
                    sum(e["factored"] for e in inside.values()),
                    sum(e["lines"] for e in inside.values()),
                    statistics.median(e["microseconds"] for e in inside.values()),
                    inside[worst]["microseconds"],
                    worst,
                ]
            )
        below = bound
    return rows


def run() -> dict[str, Any]:
    """Both sets, mesh by mesh and by thinness."""
    found: dict[str, dict[str, Any]] = {}
    for title, cases in (("made", synthetic()), ("collected", collection())):
        entries = {}
        for name, vertices, faces in cases:
            try:
                entries[name] = one(vertices, faces)
            except df.FairingError as error:
                print(f"uneven: {name} is refused, {error.code}")
        if not entries:
            continue
        found[title] = entries
        table.show(
            f"Thin plate on meshes, {title}: by longest edge over height", HEADS, summarize(entries)
        )
    return found
