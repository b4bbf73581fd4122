# SPDX-License-Identifier: GPL-3.0-or-later
"""A result of the core as a new Blender mesh, in bulk, with what its faces inherit from the control faces."""

import bpy
import numpy as np


def write_mesh(name, result, arrays, materials=(), shade_smooth=False):
    """A new bpy.types.Mesh. Faces: the triangles of `result`, then its quads; vertex i < n is control vertex i of `arrays`."""
    triangles, quads = result.faces
    origin = np.concatenate([result.triangle_polygon, result.quad_polygon])
    sharp_edges = result.crease_edges

    mesh = bpy.data.meshes.new(name)
    _write_faces(mesh, result.vertices, triangles, quads)
    for material in materials:
        mesh.materials.append(material)
    if arrays.material_index is not None and arrays.material_index.any():
        _write(mesh, "material_index", "INT", "FACE", arrays.material_index[origin])
    if not shade_smooth and arrays.sharp_face is not None and arrays.sharp_face.any():
        _write(mesh, "sharp_face", "BOOLEAN", "FACE", arrays.sharp_face[origin])
    mesh.update(calc_edges=True)
    if len(sharp_edges):
        _mark_sharp(mesh, sharp_edges)
    return mesh


def _write_faces(mesh, vertices, triangles, quads):
    corners = np.concatenate([triangles.ravel(), quads.ravel()]).astype(np.int32, copy=False)
    starts = np.concatenate(
        [3 * np.arange(len(triangles)), triangles.size + 4 * np.arange(len(quads))]
    ).astype(np.int32)
    mesh.vertices.add(len(vertices))
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(starts))
    mesh.attributes["position"].data.foreach_set("vector", vertices.astype(np.float32).ravel())
    mesh.attributes[".corner_vert"].data.foreach_set("value", corners)
    mesh.polygons.foreach_set("loop_start", starts)


def _write(mesh, name, data_type, domain, values):
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, data_type, domain)
    attribute.data.foreach_set("value", values)


def _mark_sharp(mesh, pairs):
    """Marks the edges between the vertex `pairs` (k, 2) sharp, so that smooth shading stops at creases."""
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.attributes[".edge_verts"].data.foreach_get("value", edges)
    sharp = np.isin(_keys(edges.reshape(-1, 2), len(mesh.vertices)), _keys(pairs, len(mesh.vertices)))
    _write(mesh, "sharp_edge", "BOOLEAN", "EDGE", sharp)


def _keys(pairs, vertex_count):
    """One number for each vertex pair, whichever way round it is given."""
    pairs = np.sort(np.asarray(pairs, np.int64), axis=1)
    return pairs[:, 0] * vertex_count + pairs[:, 1]
