# SPDX-License-Identifier: GPL-3.0-or-later
"""A result of the core as a new Blender mesh, in bulk."""

import bpy
import numpy as np

from ..carry.lattice import mark_pairs


def write_mesh(name, result, sharp_pairs, materials=()):
    """A new bpy.types.Mesh. Faces: the triangles of `result`, then its quads; the control vertices come first.

    The refined edges `sharp_pairs` (k, 2) are marked sharp, so that smooth shading stops there.
    """
    mesh = bpy.data.meshes.new(name)
    for material in materials:
        mesh.materials.append(material)
    fill_mesh(mesh, result, sharp_pairs)
    return mesh


def fill_mesh(mesh, result, sharp_pairs):
    """The same into a `mesh` that has no geometry. Its materials stay."""
    _write_faces(mesh, result.vertices, *result.faces)
    mesh.update(calc_edges=True)
    if len(sharp_pairs):
        _mark_sharp(mesh, sharp_pairs)


def write_positions(mesh, vertices):
    """Moves the points of `mesh` to `vertices` (N, 3): single precision goes in as one block."""
    mesh.attributes["position"].data.foreach_set("vector", vertices.astype(np.float32).ravel())
    mesh.update()


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
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.attributes[".edge_verts"].data.foreach_get("value", edges)
    _write(mesh, "sharp_edge", "BOOLEAN", "EDGE", mark_pairs(edges.reshape(-1, 2), pairs))
