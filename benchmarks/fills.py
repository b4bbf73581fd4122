# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes in known surfaces, closed by us and by others: the distance from the surface, the angle across the rim,
and the time.

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
    return result


def _off(corners: np.ndarray, holed: fill_shapes.Holed) -> float:
    steps = range(5)
    shares = np.array([(i, j, 4 - i - j) for i in steps for j in steps if i + j <= 4]) / 4
    points = np.einsum("sc,tcx->stx", shares, corners).reshape(-1, 3)
    return float(holed.distance(points).max() / holed.diameter)


def _rim(vertices: np.ndarray, faces: np.ndarray, new: np.ndarray) -> dict[str, Any]:
    """Degrees between normals: the largest across the rim, and that of the mesh beside it."""
    a, b, angle = fill_shapes.turns_at_edges(vertices, faces)
    across, old = angle[new[a] != new[b]], angle[~new[a] & ~new[b]]
    own = float(np.percentile(old, 99))
    if not len(across):
        return {"rim": None, "own": own}
    return {"rim": float(across.max()) / own, "degrees": float(across.max()), "own": own}


def _islands() -> dict[str, Any]:
    """Fills a hole of a cap with three islands, which no other of these tools takes as one hole."""
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
    return entry


def _seconds() -> dict[str, Any]:
    """CPU seconds for caps 53 degrees wide, by the length of the loop."""
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
    return result


# as the documents call the shapes and tools of `fills`
SHAPE_NAMES = {
    "half sphere": "half sphere",
    "60° cap": "cap of 60°",
    "cylinder side": "side of a cylinder",
    "torus, bite": "torus, a bite",
    "saddle": "saddle",
    "paraboloid": "paraboloid",
    "cylinder, 220°": "cylinder, 220° around",
}


TOOL_NAMES = {
    "total curvature": "total curvature",
    "thin plate": "thin plate",
    "minimum variation": "minimum variation",
    "CGAL, C1": "CGAL, C1",
    "CGAL, C2": "CGAL, C2",
    "MeshLib": "MeshLib",
    "PyMeshLab": "PyMeshLab",
    "Blender, Fill": "Blender, Fill",
    "Blender, Grid Fill": "Grid Fill",
}


def least_marked(values: list[str]) -> list[str]:
    """The numbers of one row, with the least in bold."""
    least = min(map(float, values))
    return [f"**{value}**" if float(value) == least else value for value in values]


def distances_table(result: dict[str, Any]) -> str:
    """Distances of fillings from the surface that was cut, in thousandths of the hole's diameter."""
    rows = []
    for shape, name in SHAPE_NAMES.items():
        found = result["shapes"][shape]
        off = [table.short(1000 * found[tool]["off"]) for tool in TOOL_NAMES]
        before = table.short(1000 * found["as it was"]["off"])
        rows.append([name, str(found["edges"]), before, *least_marked(off)])
    return table.markdown(["hole", "edges", "as it was", *TOOL_NAMES.values()], rows)


def rims_table(result: dict[str, Any]) -> str:
    """The largest angle across the rim, as a multiple of the largest angle of the mesh beside it."""
    shapes = result["shapes"]
    rows = [
        [name, *least_marked([table.short(shapes[shape][tool]["rim"], 3) for tool in TOOL_NAMES])]
        for shape, name in SHAPE_NAMES.items()
    ]
    return table.markdown(["hole", *TOOL_NAMES.values()], rows)


def seconds_table(result: dict[str, Any]) -> str:
    """CPU seconds against the length of a round rim."""
    found = result["seconds"]
    tools = [TOOL_NAMES[tool] for tool in next(iter(found.values()))]
    rows = [
        [edges, *(table.short(each["seconds"]) for each in entry.values())]
        for edges, entry in found.items()
    ]
    return table.markdown(["edges", *tools], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "fills.distances": distances_table(result),
        "fills.rims": rims_table(result),
        "fills.seconds": seconds_table(result),
    }
