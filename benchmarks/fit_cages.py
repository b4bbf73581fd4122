# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits on cages that the add-on makes of noisy scans, for several numbers of faces and seeds of the noise:
the means of their errors, and beside them those of the cage's Subdivision Surface, wrapped on the scan after
Taubin's filter.
"""

import sys
from pathlib import Path
from typing import Any

import fit
import fit_shapes
import numpy as np
import table

sys.path.append(str(Path(__file__).resolve().parent.parent))  # the add-on

SHAPES = ("blob", "handle")  # closed and without creases, as a cage of a scan alone is
FACES = (100, 300, 1000)
SEEDS = (1, 2, 3)
NOISE = 0.002  # of the size


def made_over(scan: fit_shapes.Mesh, faces: int) -> fit_shapes.Mesh:
    """The cage that *Fair Surface on Scan* makes, with quads and some triangles."""
    import bpy

    from addon.jobs.scan_cage import make_cage

    points, triangles = scan
    mesh = bpy.data.meshes.new("Scan")
    mesh.from_pydata(points.tolist(), [], triangles.tolist())
    dense = bpy.data.objects.new("Scan", mesh)
    bpy.context.collection.objects.link(dense)
    made = make_cage(bpy.context, [dense], faces).object
    vertices = np.array([vertex.co for vertex in made.data.vertices], float)
    faces_made = [list(face.vertices) for face in made.data.polygons]
    for used in (made, dense):
        bpy.data.meshes.remove(used.data)  # and its object
    return vertices, faces_made


def cell(shape: fit_shapes.Shape, faces: int, seed: int) -> dict[str, fit.Errors]:
    """The errors on one cage."""
    scan = shape.scanned(NOISE, seed)
    drawn = fit_shapes.Shape(shape.scan, made_over(scan, faces), shape.nearest, shape.options)
    return {
        "faces": (float(len(drawn.cage[1])), 0.0),
        "Taubin, Shrinkwrap": fit.wrapped_on(drawn, fit.smoothed(scan)),
        "fit": fit.fitted(drawn, scan)[1],
    }


def run() -> dict[str, Any]:
    """The means over the seeds, by shape and number of faces."""
    out: dict[str, Any] = {}
    for name in SHAPES:
        shape = fit_shapes.SHAPES[name]()
        for faces in FACES:
            cells = [cell(shape, faces, seed) for seed in SEEDS]
            out[f"{name} · {faces}"] = {
                surface: np.mean([each[surface] for each in cells], axis=0).tolist()
                for surface in cells[0]
            }
    return out


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The table of the documents, by name."""
    surfaces = list(next(iter(result.values())))[1:]
    rows = [
        [
            label,
            f"{found['faces'][0]:.0f}",
            *(f"{table.short(found[n][0])} · {table.short(found[n][1])}°" for n in surfaces),
        ]
        for label, found in result.items()
    ]
    return {"fit.cages": table.markdown(["shape · faces", "made", *surfaces], rows)}
