# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of STEP files from their surfaces: Open CASCADE reads each file and evaluates its faces, with no
evaluation of our own; the distance is that from the triangles of the refined surface. The triangles are
flat: where they bend, their own sag, some 1e-6 of the size at level 6, is part of the distance.
"""

import tempfile
from pathlib import Path
from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import step_files
import table
from scipy.spatial import cKDTree

POINTS = 100_000
CAGES = ("cat_head.obj", "bob_small.ply")
NEAREST = 12  # points of the surface, all of whose triangles are looked at


def surfaces():
    """Yields name, mesh and options of each surface."""
    mesh, creases = from_tests.importlib.import_module("example_meshes").hull()
    yield "hull", mesh, {"crease_edges": creases}
    for file in CAGES:
        if mesh := from_tests.collected(file):
            yield file.split(".")[0], mesh, {}


def file_points(shape, count: int) -> np.ndarray:
    """(k, 3) points of a file's faces, evenly in their parameters: `count` and a few more, less those outside of a plane's rim."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.BRepClass import BRepClass_FaceClassifier
    from OCP.GeomAbs import GeomAbs_SurfaceType
    from OCP.gp import gp_Pnt2d
    from OCP.TopAbs import TopAbs_ShapeEnum, TopAbs_State
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    faces, search = [], TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    while search.More():
        cast = getattr(TopoDS, "Face_s", None) or TopoDS.Face
        faces.append(BRepAdaptor_Surface(cast(search.Current())))
        search.Next()

    def is_inside(face, place) -> bool:
        state = BRepClass_FaceClassifier(face.Face(), gp_Pnt2d(*place), 1e-9).State()
        return state != TopAbs_State.TopAbs_OUT

    each = int(np.ceil(np.sqrt(count / len(faces))))
    found = []
    for face in faces:
        u, v = (
            np.linspace(low, high, each)
            for low, high in (
                (face.FirstUParameter(), face.LastUParameter()),
                (face.FirstVParameter(), face.LastVParameter()),
            )
        )
        places = [(float(a), float(b)) for a in u for b in v]
        if face.GetType() == GeomAbs_SurfaceType.GeomAbs_Plane:  # others end with their parameters
            places = [p for p in places if is_inside(face, p)]
        found += [face.Value(*place).Coord() for place in places]
    return np.array(found)


def distances(points: np.ndarray, vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(k,): distances of points from the nearest triangle around the vertices next to them."""
    corner = np.argsort(triangles.ravel(), kind="stable")
    first = np.searchsorted(triangles.ravel()[corner], np.arange(len(vertices) + 1))
    found = np.full(len(points), np.inf)
    _, near = cKDTree(vertices).query(points, NEAREST)
    for vertex in near.T:
        uses = first[vertex + 1] - first[vertex]
        for k in range(uses.max()):
            own = np.flatnonzero(uses > k)
            triangle = triangles[corner[first[vertex[own]] + k] // 3]
            found[own] = np.minimum(found[own], _from_triangle(points[own], vertices[triangle]))
    return found


def _from_triangle(p: np.ndarray, corners: np.ndarray) -> np.ndarray:
    a, b, c = corners.transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    inside = length > 0
    nearest = np.full(len(p), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        edge = end - start
        square = np.einsum("ij,ij->i", edge, edge)
        share = np.einsum("ij,ij->i", p - start, edge) / np.where(square > 0, square, 1.0)
        foot = start + np.clip(share, 0, 1)[:, None] * edge
        nearest = np.minimum(nearest, np.linalg.norm(p - foot, axis=1))
        inside &= np.einsum("ij,ij->i", np.cross(edge, p - start), normal) >= 0
    height = np.abs(np.einsum("ij,ij->i", p - a, normal)) / np.where(length > 0, length, 1.0)
    return np.where(inside, height, nearest)


def measured(mesh, options) -> dict[str, float]:
    """The distances of one surface's file, as shares of the size."""
    patches = df.fit_patches(*mesh, **options)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "surface.step"
        df.write_step(file, patches, unit="mm")
        points = file_points(step_files.read(file).shape, POINTS)
    result = patches.result
    found = distances(points, result.vertices, result.triangles.astype(np.int64)) / patches.size
    return {
        "level": patches.levels,
        "patches": len(patches),
        "points": len(points),
        "median": float(np.median(found)),
        "99 %": float(np.quantile(found, 0.99)),
        "largest": float(found.max()),
        "own": float(patches.largest_residual / patches.size),
    }


def run() -> dict[str, dict[str, float]]:
    """Measures all surfaces."""
    found = {name: measured(mesh, options) for name, mesh, options in surfaces()}
    return found


def step_distances_table(result: dict[str, Any]) -> str:
    """STEP files as another program evaluates them, from their surfaces."""
    rows = [
        [
            name,
            *(f"{case[k]:,}".replace(",", " ") for k in ("level", "patches", "points")),
            *(f"{case[k]:.1e}" for k in ("median", "99 %", "largest", "own")),
        ]
        for name, case in result.items()
    ]
    heads = ["file", "level", "patches", "points", "median", "99 %", "largest"]
    return table.markdown([*heads, "the patches' own largest"], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "step_distances": step_distances_table(result),
    }
