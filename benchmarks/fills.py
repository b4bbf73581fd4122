# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes in known surfaces, closed by us and by others: how far from the surface, how smooth across the
rim, and how long that takes.

The half sphere has nothing but its rim and the bend there to go by. Distances are those of 15 points a
triangle, so that the chords of the true triangles are told as well ("as it was").
"""

from typing import Any

import control_meshes
import discrete_fairing as df
import fill_rivals
import fill_shapes
import numpy as np
import table

LIMIT = 300.0  # seconds a run
AROUND = (8, 16, 32, 64, 128)  # subdivisions of spheres, of which a band around a hole is kept
ROWS = 4  # of faces, in edges, that stay around it
TIMED = ("total curvature", "thin plate", "CGAL, C1", "CGAL, C2", "MeshLib", "PyMeshLab")


def run() -> dict[str, Any]:
    return {"shapes": _shapes(), "islands": _islands(), "seconds": _seconds()}


def _shapes() -> dict[str, Any]:
    result: dict[str, Any] = {}
    for shape, make in fill_shapes.SHAPES.items():
        holed = make()
        known = {tuple(sorted(face)) for face in holed.faces.tolist()}
        result[shape] = {
            "edges": len(holed.hole),
            "as it was": {"off": _off(holed.gone, holed)},
        }
        for name in fill_rivals.MAKERS:
            found = fill_rivals.made(name, (holed.vertices, holed.faces, holed.hole), LIMIT)
            if isinstance(found, str):
                result[shape][name] = {"why not": found}
                continue
            vertices, faces, seconds = found
            new = np.array([tuple(sorted(face)) not in known for face in faces.tolist()])
            result[shape][name] = {
                "off": _off(vertices[faces[new]], holed) if new.any() else None,
                **_rim(vertices, faces, new),
                "new faces": int(new.sum()),
                "seconds": seconds,
            }
    _show(result, "off", "Largest distance from the surface, over the hole's diameter")
    _show(result, "rim", "Largest angle across the rim, over the 99th percentile of the mesh's own")
    return result


def _off(corners: np.ndarray, holed: fill_shapes.Holed) -> float:
    steps = range(5)
    shares = np.array([(i, j, 4 - i - j) for i in steps for j in steps if i + j <= 4]) / 4
    points = np.einsum("sc,tcx->stx", shares, corners).reshape(-1, 3)
    return float(holed.distance(points).max() / holed.diameter)


def _rim(vertices: np.ndarray, faces: np.ndarray, new: np.ndarray) -> dict[str, Any]:
    """Degrees between normals: across the rim at most, and of the mesh beside it."""
    a, b, angle = fill_shapes.turns_at_edges(vertices, faces)
    across, old = angle[new[a] != new[b]], angle[~new[a] & ~new[b]]
    own = float(np.percentile(old, 99))
    if not len(across):
        return {"rim": None, "own": own}
    return {"rim": float(across.max()) / own, "degrees": float(across.max()), "own": own}


def _show(result: dict[str, Any], key: str, title: str) -> None:
    names = (["as it was"] if key == "off" else []) + list(fill_rivals.MAKERS)
    rows = []
    for shape, entries in result.items():
        values = [entries[name].get(key) for name in names]
        rows.append([shape, entries["edges"], *("–" if v is None else v for v in values)])
    table.show(title, ["shape", "edges", *names], rows)


def _islands() -> dict[str, Any]:
    """Three islands in one hole of a cap, which no other of these tools takes as one hole."""
    points, faces = control_meshes.sphere(24, rough=0.0)
    centre = points[faces].mean(1)
    gone = centre[:, 2] > 0.6
    for angle in np.radians([0, 120, 240]):
        middle = np.array([0.4 * np.cos(angle), 0.4 * np.sin(angle), 0.917])
        gone &= np.linalg.norm(centre - middle, axis=1) > 0.15
    used, kept = np.unique(faces[~gone], return_inverse=True)
    vertices, kept = points[used], kept.reshape(-1, 3)
    loops = sorted(df.find_holes(vertices, kept), key=len, reverse=True)
    filled = df.fill_holes(vertices, kept, holes=[loops])
    (hole,) = filled.holes
    off = abs(np.linalg.norm(filled.vertices[len(vertices) :], axis=1) - 1).max()
    entry = {
        "loops": [len(loop) for loop in loops],
        "off": float(off),
        "energy": hole.energy,
        "folds": hole.folds,
        "closed": not df.find_holes(filled.vertices, filled.faces),
    }
    table.show("Three islands in a hole of a sphere", list(entry), [list(map(str, entry.values()))])
    return entry


def _seconds() -> dict[str, Any]:
    """Of the processor, for caps of 53 degrees' width, by the length of the loop."""
    result: dict[str, Any] = {}
    slow: set[str] = set()
    for m in AROUND:
        points, faces = control_meshes.sphere(m, rough=0.0)
        z = points[faces][:, :, 2]
        edge = 1.1 / m
        band = (z.min(1) < 0.8) & (z.max(1) > 0.8 - ROWS * edge)
        used, kept = np.unique(faces[band], return_inverse=True)
        vertices, kept = points[used], kept.reshape(-1, 3)
        hole = max(df.find_holes(vertices, kept), key=lambda h: vertices[h][:, 2].mean())
        entry: dict[str, Any] = {}
        for name in TIMED:
            if name in slow:
                continue
            found = fill_rivals.made(name, (vertices, kept, hole), LIMIT)
            if isinstance(found, str):
                entry[name] = {"why not": found}
                slow.add(name)
            else:
                new = len(found[1]) - len(kept)
                entry[name] = {"seconds": found[2], "new faces": new}
        result[str(len(hole))] = entry
    rows = [
        [edges, *(entry.get(n, {}).get("seconds", "–") for n in TIMED)]
        for edges, entry in result.items()
    ]
    table.show("Seconds of the processor by the edges around", ["edges", *TIMED], rows)
    return result
