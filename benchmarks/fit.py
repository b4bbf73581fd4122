# SPDX-License-Identifier: GPL-3.0-or-later
"""Noisy scans of known shapes with a cage each: the errors of surfaces on the scan. The rivals are those of
Blender's users: the cage's Subdivision Surface with the modifier Shrinkwrap, its best mode, onto the scan
itself, and onto the scan after Taubin's filter.
"""

from typing import Any

import discrete_fairing as df
import fit_shapes
import numpy as np
import rivals
import table

LEVELS = 3
NOISES = (0.0, 0.002, 0.005)  # of the size
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


def surfaces(shape: fit_shapes.Shape, noise: float) -> dict[str, tuple[float, float]]:
    """The errors of each surface."""
    points, triangles = shape.scanned(noise, 1)

    def fitted(weight: float | None = None) -> tuple[df.Fitted, tuple[float, float]]:
        arguments = {"triangles": triangles, "levels": LEVELS, "weight": weight, **shape.options}
        found = df.fit(*shape.cage, points, **arguments)
        return found, shape.errors(found.vertices, found.triangles)

    surface, own = fitted()
    tried = [own, *(fitted(surface.weight * factor)[1] for factor in FACTORS)]
    creases = shape.options.get("crease_edges", np.empty((0, 2), int))
    subdivided = rivals.catmull_clark(*shape.cage, LEVELS, creases.tolist())
    smooth = df.denoise(points, triangles, passes=PASSES).vertices

    def best(target: np.ndarray) -> tuple[float, float]:
        """The errors of the mode that is nearest in normals."""
        wrapped = (shrinkwrapped(subdivided, target, triangles, mode) for mode in MODES)
        return min((shape.errors(each, subdivided[1]) for each in wrapped), key=lambda e: e[1])

    return {
        "scan": shape.errors(points, triangles),
        "Shrinkwrap": best(points),
        "Taubin, Shrinkwrap": best(smooth),
        "fit": own,
        "at its best weights": (min(e[0] for e in tried), min(e[1] for e in tried)),
    }


def run() -> dict[str, Any]:
    """The errors by shape and noise."""
    result: dict[str, Any] = {}
    for name, make in fit_shapes.SHAPES.items():
        shape = make()
        for noise in NOISES:
            result[f"{name} · {100 * noise:g} %"] = surfaces(shape, noise)
    return result


def fit_table(result: dict[str, Any]) -> str:
    """The distance and angle of each surface from the true one."""
    names = list(next(iter(result.values())))
    rows = [
        [label, *(f"{table.short(found[n][0])} · {table.short(found[n][1])}°" for n in names)]
        for label, found in result.items()
    ]
    return table.markdown(["shape · noise", *names], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {"fit": fit_table(result)}
