# SPDX-License-Identifier: GPL-3.0-or-later
"""Discrete Fairing beside other programs that its users have: the same control meshes, the same measures for
all.

    python3 build_tools/dev.py bench side_by_side
    .venv/bin/python benchmarks/side_by_side.py

A tool that is not installed, or does not take a mesh, leaves a line that says so.
"""

import argparse
import json
from collections.abc import Collection
from pathlib import Path
from typing import Any

import from_tests
import numpy as np
import rivals
import table
import timing
from from_tests import measures

ROOT = Path(__file__).resolve().parent.parent
LEVELS, FREE_FORM_LEVELS = (
    5,
    3,
)  # fewer for meshes of hundreds of faces, whose surfaces would have a million
SPHERE = 8 * np.pi  # ∫ κ₁² + κ₂² of any sphere; no closed surface without handles has less
REPEATS, ENOUGH = (
    3,
    1.0,
)  # runs, of which the shortest counts; CPU seconds after which one will do


# seconds are the processor's, of all threads together: other work on the machine hardly moves them
def control_meshes() -> dict[str, tuple[np.ndarray, list[list[int]], int, bool]]:
    """By name: vertices, polygons, levels, and whether all vertices are on the unit sphere."""
    rivals.load_early()
    small = from_tests.small_meshes()
    inscribed = {
        "icosahedron": small.icosahedron(),
        "octahedron": small.octahedron(),
        "tetrahedron": small.tetrahedron(),
        "cube": small.cube(),
        "hull of 20 points": small.random_hull(20),
        "hull of 40 points": small.random_hull(40),
    }
    result = {
        name: (points / np.linalg.norm(points[0]), [list(map(int, f)) for f in faces], LEVELS, True)
        for name, (points, faces) in inscribed.items()
    }
    points, faces = small.creature()
    result["creature"] = (points, [list(map(int, f)) for f in faces], FREE_FORM_LEVELS, False)
    try:
        result["Suzanne"] = (*suzanne(), FREE_FORM_LEVELS, False)
    except rivals.Missing as why:
        print(f"side_by_side: no Suzanne, {why}")
    return result


def suzanne() -> tuple[np.ndarray, list[list[int]]]:
    """Blender's monkey: a head with open eye sockets, and two eyes."""
    bpy = rivals.installed("bpy", "bpy")
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_monkey_add()
    mesh = bpy.context.active_object.data
    return np.array([v.co for v in mesh.vertices], float), [list(p.vertices) for p in mesh.polygons]


def projected(points: np.ndarray, polygons: list[list[int]], levels: int) -> rivals.Surface:
    """The flat faces refined and pushed out to the sphere: the figures of a perfect answer."""
    triangles = rivals.triangulate(points, polygons)
    for _ in range(levels):
        points, triangles = halved(points, triangles)
    return points / np.linalg.norm(points, axis=1)[:, None], triangles


def halved(points: np.ndarray, triangles: np.ndarray) -> rivals.Surface:
    """Refines linearly by one level."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1)
    edges, inverse = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (inverse.reshape(-1, 3) + len(points)).T
    a, b, c = triangles.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([points, points[edges].mean(1)]), np.concatenate(
        [np.stack(p, -1) for p in parts]
    )


def measured(control: np.ndarray, surface: rivals.Surface, inscribed: bool) -> dict[str, Any]:
    """The figures of one surface."""
    from scipy.spatial import cKDTree

    points, triangles = surface
    radius = np.linalg.norm(points, axis=1)
    off, _ = cKDTree(points).query(control)
    return {
        "least_radius": float(radius.min()) if inscribed else None,
        "largest_radius": float(radius.max()) if inscribed else None,
        "off": float(off.max()),
        "dihedral": float(measures.dihedrals(points, triangles).max()),
        "energy": measures.total_curvature(points, triangles) / SPHERE,
        "triangles": len(triangles),
    }


def entry(
    rival: rivals.Rival, points: np.ndarray, polygons: Any, levels: int, inscribed: bool
) -> Any:
    """The figures of one tool on one mesh, or {"absent": why}."""
    try:
        surface, *times = timing.measured(lambda: rival.make(points, polygons, levels))
        for _ in range(REPEATS - 1):
            if times[1] < ENOUGH:
                again = timing.measured(lambda: rival.make(points, polygons, levels))[1:]
                times = [min(pair) for pair in zip(times, again)]
    except rivals.Missing as why:
        return {"absent": str(why), "missing": True}
    except rivals.Refused as why:
        return {"absent": str(why)}
    if not np.isfinite(surface[0]).all():
        return {"absent": "gives positions that are not finite"}
    if surface[1].min() < 0 or surface[1].max() >= len(surface[0]):
        return {"absent": "gives triangles with vertices that do not exist"}
    return measured(points, surface, inscribed) | {"wall": times[0], "seconds": times[1]}


def run(without: Collection[str] = ()) -> dict[str, Any]:
    """All tools but those `without`; prints a table for each control mesh."""
    result: dict[str, Any] = {"versions": rivals.versions(), "levels": {}, "meshes": {}}
    told = set()
    for name, (points, polygons, levels, inscribed) in control_meshes().items():
        found = {}
        for rival in rivals.ALL:
            if rival.name in without:
                continue
            figures = entry(rival, points, polygons, levels, inscribed)
            if figures.get("missing"):
                told |= {figures["absent"]}
            else:
                found[rival.name] = figures
        if inscribed:
            exact = measured(points, projected(points, polygons, levels), True)
            found["(exact sphere)"] = exact | {"seconds": None}
        result["meshes"][name], result["levels"][name] = found, levels
    for line in sorted(told):
        print(f"side_by_side: left out, {line}")
    return result


def main() -> None:
    """Runs this benchmark without the others."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument(
        "--without", action="append", default=[], metavar="TOOL", help="may be repeated"
    )
    options = parser.parse_args()
    result = run(options.without)
    out = ROOT / "out" / "bench"
    out.mkdir(parents=True, exist_ok=True)
    (out / "side_by_side.json").write_text(json.dumps(result, indent=1) + "\n")


# Of the tools in `side_by_side`, those whose surface misses the control vertices.
MISSES = ("Catmull-Clark", "Loop", "(exact sphere)")


MEASURES = ("least_radius", "largest_radius", "off", "dihedral", "energy", "triangles", "seconds")


COLUMNS = (
    "",
    "least radius",
    "largest radius",
    "off",
    "dihedral",
    "E / 8π",
    "triangles",
    "seconds",
)


def table_cells(figures: dict[str, Any]) -> list[str]:
    """The cells of one tool's surface, in the order of MEASURES."""
    forms = ("{:.5f}", "{:.5f}", "{:.3g}", "{:.2f}", "{:.4f}", "{:,}", "{:.3f}")
    values = [figures[key] for key in MEASURES]
    return ["" if v is None else form.format(v) for form, v in zip(forms, values, strict=True)]


def table_of(result: dict[str, Any], name: str) -> str:
    """The surfaces of all tools over one mesh; bold is the best of those through the vertices."""
    found = result["meshes"][name]
    rows = {tool: table_cells(f) for tool, f in found.items() if "absent" not in f}
    ours = [cells for tool, cells in rows.items() if tool not in MISSES]
    best = {
        k: min((cells[k] for cells in ours), key=float)
        for k in (MEASURES.index("dihedral"), MEASURES.index("energy"))
    }
    shown = range(len(MEASURES)) if "(exact sphere)" in found else range(2, len(MEASURES))
    lines = []
    for tool, figures in found.items():
        if tool not in rows:
            lines.append([tool, f"*{figures['absent']}*", *[""] * (len(shown) - 1)])
            continue
        cells = list(rows[tool])
        cells[3] += "°"
        for k, value in best.items():
            if tool not in MISSES and rows[tool][k] == value:
                cells[k] = f"**{cells[k]}**"
        lines.append([tool, *(cells[k] for k in shown)])
    levels = result["levels"][name]
    heading = f"\n\n### {name[0].upper()}{name[1:]}, {levels} levels"
    return heading + table.markdown([COLUMNS[0], *(COLUMNS[k + 1] for k in shown)], lines)


def all_tables(result: dict[str, Any]) -> str:
    """The tables of all meshes, each under a heading."""
    parts = [table_of(result, name).strip() for name in result["meshes"]]
    return "\n\n" + "\n\n".join(parts) + "\n\n"


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "comparison": all_tables(result),
    }


if __name__ == "__main__":
    main()
