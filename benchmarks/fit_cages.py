# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits on cages that QuadriFlow makes of noisy scans, for several numbers of faces and seeds of the noise:
the means of their errors, and beside them those of the cage's Subdivision Surface, wrapped on the scan after
Taubin's filter.
"""

from typing import Any

import fit
import fit_shapes
import numpy as np
import table

SHAPES = ("blob", "handle")  # closed and without creases, as a cage of a scan alone is
FACES = (100, 300, 1000)
SEEDS = (1, 2, 3)
NOISE = 0.002  # of the size


def quadriflow(scan: fit_shapes.Mesh, faces: int) -> Any:
    """A cage, nearly all quads, by Blender's QuadriFlow, whose double vertices are merged and whose
    small holes are closed, as the add-on does.
    """
    import bpy  # isort: skip - before bmesh, which it contains
    import bmesh

    points, triangles = scan
    mesh = bpy.data.meshes.new("Cage")
    mesh.from_pydata(points.tolist(), [], triangles.tolist())
    cage = bpy.data.objects.new("Cage", mesh)
    bpy.context.collection.objects.link(cage)
    bpy.context.view_layer.objects.active = cage
    cage.select_set(True)
    bpy.ops.object.quadriflow_remesh(mode="FACES", target_faces=faces, use_preserve_sharp=False)
    made = cage.data
    edit = bmesh.new()
    edit.from_mesh(made)
    apart = 1e-6 * max(cage.dimensions)
    bmesh.ops.remove_doubles(edit, verts=list(edit.verts), dist=apart)
    bmesh.ops.dissolve_degenerate(edit, dist=apart, edges=list(edit.edges))
    open_edges = [edge for edge in edit.edges if edge.is_boundary]
    bmesh.ops.holes_fill(edit, edges=open_edges, sides=4)
    bmesh.ops.triangulate(edit, faces=[face for face in edit.faces if len(face.verts) > 4])
    edit.to_mesh(made)
    edit.free()
    vertices = np.array([vertex.co for vertex in made.vertices], float)
    faces_made = [list(face.vertices) for face in made.polygons]
    bpy.data.objects.remove(cage)
    bpy.data.meshes.remove(made)
    return vertices, faces_made


def cell(shape: fit_shapes.Shape, faces: int, seed: int) -> dict[str, fit.Errors]:
    """The errors on one cage."""
    scan = shape.scanned(NOISE, seed)
    drawn = fit_shapes.Shape(shape.scan, quadriflow(scan, faces), shape.nearest, shape.options)
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
