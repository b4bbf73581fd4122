# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of time and memory, by the names under which documents have them."""

from collections.abc import Callable
from statistics import median
from typing import Any

from results import result, short, table


def energies() -> dict[str, Any]:
    """The meshes that pads and energies were timed on, by name and level."""
    return result("energies")


def pads_table() -> str:
    """Pads beside point forces, both energies."""
    heads = ["control mesh, level", "thin plate, point forces", "on pads", "ratio"]
    heads += ["total curvature, point forces", "on pads", "ratio"]
    rows = []
    for name, e in energies().items():
        points, pads = e["curvature on needles"], e["curvature"]
        row = [f"{e['plate on needles']:.3f} s", f"{e['plate']:.3f} s", short(e["pads"], 3)]
        rows.append([name, *row, f"{points:.2f} s", f"{pads:.2f} s", short(pads / points, 3)])
    return table(heads, rows)


def total_curvature_table() -> str:
    """Total curvature beside the thin plate, and what its finest level took."""
    heads = ["control mesh, level", "thin plate", "total curvature", "ratio"]
    heads += ["steps", "iterations", "factors"]
    rows = []
    for name, e in energies().items():
        times = [f"{e['plate']:.3f} s", f"{e['curvature']:.2f} s", short(e["ratio"])]
        work = [str(e["work"][key]) for key in ("steps", "iterations", "factors")]
        rows.append([name, *times, *work])
    return table(heads, rows)


def wall(size: str, tool: str) -> float | None:
    """The median time of a tool in `peers`; None where it took too long to be run."""
    times = result("peers")[size].get(tool, {}).get("wall")
    return median(times) if times else None


def sizes_of_peers() -> list[str]:
    return [name for name, found in result("peers").items() if isinstance(found, dict)]


def peers_table() -> str:
    """The same job by other tools; in brackets the ratio to ours on one thread."""
    ours = {
        "ours, one thread": "ours, one thread",
        "ours, two threads": "ours, two",
        "ours, default settings, two threads": "ours, default settings, two",
        "ours, warm, one thread": "ours, warm, one thread",
    }
    theirs = {
        "CHOLMOD": "CHOLMOD, one thread",
        "CHOLMOD, analysis kept": "CHOLMOD without analysis, one thread",
        "Eigen LDLT": "Eigen SimplicialLDLT",
        "CGAL": "CGAL fair",
        "libigl": "libigl harmonic",
        "Manifold": "manifold3d smooth",
    }
    sizes = sizes_of_peers()
    rows = []
    for label, tool in {**ours, **theirs}.items():
        row = [label]
        for size in sizes:
            time, unit = wall(size, tool), wall(size, "ours, one thread")
            assert unit
            ratio = f" ({short(time / unit)})" if time and label in theirs else ""
            row.append(f"{short(time)}{ratio}" if time else "–")
        rows.append(row)
    heads = [
        size.replace(",", " triangles,", 1).replace("faces", "control faces") for size in sizes
    ]
    return table(["seconds", *heads], rows)


SIZES = {
    "L = 3": "small faces: level 3",
    "by levels": "large faces: more levels",
    "quads, L = 2": "quads, level 2",
}


def sizes_table() -> str:
    """Processor time and memory by the number of triangles."""
    heads = ["control mesh", "triangles", "seconds of the processor"]
    heads += ["iterations", "bytes a triangle"]
    rows = [
        [
            label,
            f"{p['triangles']:,}",
            short(p["processor"]),
            str(p["iterations"][-1]),
            f"{p['resident']:.0f}",
        ]
        for key, label in SIZES.items()
        for p in result("sizes")[key]["points"]
    ]
    return table(heads, rows)


def drag_table() -> str:
    """Moves of a vertex by a `Solver`."""
    heads = ["control mesh, level", "pad size", "first moves", "following", "slowest of these"]
    rows = []
    for key, d in result("drag").items():
        name, pad = key.rsplit(", ", 1)
        first = f"{d['first']:.0f} ms, {d['first_iterations']} iterations"
        following = f"{d['following']:.1f} ms, {d['iterations']}"
        rows.append([name, f"{float(pad):.0f}", first, following, f"{d['most']:.0f} ms"])
    return table(heads, rows)


def pieces_table() -> str:
    """Surfaces made in pieces, by their size."""
    heads = ["triangles", "pieces", "a worker's peak, all its memory"]
    heads += ["time", "processor", "on disk", "largest jump / size"]
    rows = []
    for s in result("piecewise")["sizes"]:
        work, share = s["work"], s["judge"]["jump"]["share"]
        row = [f"{s['triangles'] / 1e6:.3g} million", str(s["pieces"])]
        row += [f"{work['resident_bytes'] / 1e6:,.0f} MB"]
        row += [
            f"{work[clock]:,.3g} s" if work[clock] < 1000 else f"{work[clock]:,.0f} s"
            for clock in ("wall", "processor")
        ]
        rows.append([*row, f"{s['bytes_of_parts'] / 1e6:,.0f} MB", short(share) if share else "–"])
    return table(heads, rows)


def rings_table() -> str:
    """How far pieces are from the whole, by rings."""
    found = result("piecewise")["rings"]
    rings = sorted({r["rings"] for r in found})
    rows: dict[str, list[str]] = {}
    for r in found:
        name = f"{r['energy'].replace('_', ' ')}, {r['mesh']}"
        rows.setdefault(name, []).append(f"{r['difference']:.1e}".replace("e-0", "e-"))
    heads = ["rings", *(str(r) for r in rings)]
    return table(heads, [[name, *cells] for name, cells in rows.items()])


COST: dict[str, Callable[[], str]] = {
    "pads.cost.table": pads_table,
    "total_curvature.cost.table": total_curvature_table,
    "peers.table": peers_table,
    "sizes.table": sizes_table,
    "drag.table": drag_table,
    "pieces.table": pieces_table,
    "pieces.rings.table": rings_table,
}
