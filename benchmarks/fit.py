# SPDX-License-Identifier: GPL-3.0-or-later
"""Noisy scans of known shapes with a cage each: the errors of surfaces on the scan. The rivals are those of
Blender's users: the cage's Subdivision Surface with the modifier Shrinkwrap, its best mode, onto the scan
itself, and onto the scan after Taubin's filter; of scans with defects PyMeshLab's screened Poisson with the
same filter, too.
"""

from collections.abc import Iterable
from typing import Any

import discrete_fairing as df
import fit_shapes
import numpy as np
import rivals
import table
from discrete_fairing.denoising import Stars

LEVELS = 3
NOISES = (0.0, 0.002, 0.005)  # of the size
KINDS = ("correlated", "strays", "holes", "uneven")  # of scans with the second noise
DEPTHS = (5, 6)  # of Poisson's octree; deeper ones follow the noise
MODES = ("NEAREST_SURFACEPOINT", "TARGET_PROJECT", "PROJECT", "NEAREST_VERTEX")
PASSES = 10  # Taubin's
FACTORS = (1 / 16, 1 / 4, 4, 16)  # of the weight, for others than the one chosen


def shrinkwrapped(
    surface: fit_shapes.Mesh, points: np.ndarray, triangles: np.ndarray, mode: str
) -> np.ndarray:
    """Wraps the surface by Blender's modifier; PROJECT goes along the normals, both ways."""
    import bpy

    def added(name: str, vertices: np.ndarray, faces: np.ndarray) -> Any:
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices.tolist(), [], faces.tolist())
        made = bpy.data.objects.new(name, mesh)
        bpy.context.collection.objects.link(made)
        return made

    scan, wrapped = added("Scan", points, triangles), added("Surface", *surface)
    modifier = wrapped.modifiers.new("Shrinkwrap", "SHRINKWRAP")
    modifier.target, modifier.wrap_method = scan, mode
    modifier.use_negative_direction = modifier.use_positive_direction = True
    shown = wrapped.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    out = np.array([vertex.co for vertex in shown.vertices])
    for used in (scan, wrapped):
        mesh = used.data
        bpy.data.objects.remove(used)
        bpy.data.meshes.remove(mesh)
    return out


def poisson(points: np.ndarray, triangles: np.ndarray, depth: int) -> fit_shapes.Mesh:
    """Screened Poisson through the points with the scan's normals, and Taubin's filter."""
    import pymeshlab as ml

    work = ml.MeshSet(verbose=False)
    work.add_mesh(ml.Mesh(points, triangles.astype(np.int32)))
    work.generate_surface_reconstruction_screened_poisson(depth=depth, preclean=True, threads=1)
    work.apply_coord_taubin_smoothing(stepsmoothnum=PASSES)
    mesh = work.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


Errors = tuple[float, float]  # of distance and of normals


def best(found: Iterable[Errors]) -> Errors:
    """Those that are least in normals."""
    return min(found, key=lambda errors: errors[1])


def wrapped_on(shape: fit_shapes.Shape, scan: fit_shapes.Mesh) -> Errors:
    """The errors of the cage's Subdivision Surface on a scan, in the best mode."""
    creases = shape.options.get("crease_edges", np.empty((0, 2), int))
    subdivided = rivals.catmull_clark(*shape.cage, LEVELS, creases.tolist())
    found = (shrinkwrapped(subdivided, *scan, mode) for mode in MODES)
    return best(shape.errors(each, subdivided[1]) for each in found)


def smoothed(scan: fit_shapes.Mesh) -> fit_shapes.Mesh:
    """The scan after Taubin's filter."""
    points, triangles = scan
    stars = Stars(len(points), triangles.ravel(), 3 * np.arange(len(triangles) + 1))
    free = (~stars.on_border & (stars.counts > 0))[:, None]
    filtered = stars.ordered(points)
    for share in (0.6307, -0.6732) * PASSES:  # a pass band of 0.1
        filtered = filtered - share * free * stars.off_mean(filtered)
    return stars.as_given(filtered), triangles


def wrapped(shape: fit_shapes.Shape, scan: fit_shapes.Mesh) -> dict[str, Errors]:
    """The errors of the scan and of surfaces wrapped on it."""
    return {
        "scan": shape.errors(*scan),
        "Shrinkwrap": wrapped_on(shape, scan),
        "Taubin, Shrinkwrap": wrapped_on(shape, smoothed(scan)),
    }


def fitted(
    shape: fit_shapes.Shape, scan: fit_shapes.Mesh, weight: float | None = None
) -> tuple[float, Errors]:
    """The weight and errors of a fit."""
    points, triangles = scan
    arguments = {"triangles": triangles, "levels": LEVELS, "weight": weight, **shape.options}
    found = df.fit(*shape.cage, points, **arguments)
    return found.weight, shape.errors(found.vertices, found.triangles)


def with_noise(shape: fit_shapes.Shape, noise: float) -> dict[str, Errors]:
    """The errors near a scan with white noise, and the least ones of other weights."""
    scan = shape.scanned(noise, 1)
    weight, own = fitted(shape, scan)
    tried = [own, *(fitted(shape, scan, weight * factor)[1] for factor in FACTORS)]
    least = min(e[0] for e in tried), min(e[1] for e in tried)
    return wrapped(shape, scan) | {"fit": own, "at its best weights": least}


def with_defects(shape: fit_shapes.Shape, kind: str) -> dict[str, Errors]:
    """The errors near a scan of that kind."""
    scan = shape.scanned(NOISES[1], 1, kind)
    rebuilt = best(shape.errors(*shape.near(*poisson(*scan, depth))) for depth in DEPTHS)
    return wrapped(shape, scan) | {"Poisson, Taubin": rebuilt, "fit": fitted(shape, scan)[1]}


def run() -> dict[str, Any]:
    """The errors by shape and noise, and by shape and kind of scan."""
    noises: dict[str, Any] = {}
    kinds: dict[str, Any] = {}
    for name, make in fit_shapes.SHAPES.items():
        shape = make()
        for noise in NOISES:
            noises[f"{name} · {100 * noise:g} %"] = with_noise(shape, noise)
        for kind in KINDS[:-1] if shape.options else KINDS:  # points would move off curves
            kinds[f"{name} · {kind}"] = with_defects(shape, kind)
    return {"noises": noises, "kinds": kinds}


def fit_table(result: dict[str, Any], head: str) -> str:
    """The distance and angle of each surface from the true one."""
    names = list(next(iter(result.values())))
    rows = [
        [label, *(f"{table.short(found[n][0])} · {table.short(found[n][1])}°" for n in names)]
        for label, found in result.items()
    ]
    return table.markdown([head, *names], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "fit": fit_table(result["noises"], "shape · noise"),
        "fit.scans": fit_table(result["kinds"], "shape · scan"),
    }
