# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices where the surface has a normal that somebody chose: a vector on points, of length one and
in the coordinates of the object. Shorter ones, and no attribute: the surface finds its own. So those
that Blender mixes on new vertices, of one that is fixed and one that is not, fix nothing.
"""

from collections.abc import Callable, Iterable

import bmesh
import numpy as np
from mathutils import Vector

from ..blender import Mesh, Object, column
from .layers import find_layer, layer_values
from .mesh_changes import shown
from .world_shape import world_matrix

NORMAL = "fair_normal"

_LEAST = 0.999  # of lengths: single precision and mixing of equal ones leave a little less than one


def read_normals(mesh: Mesh) -> np.ndarray | None:
    """(n, 3) float32, zero where the surface is free; None where it is so everywhere. `mesh` is not
    in Edit Mode.
    """
    layer = find_layer(mesh, NORMAL, "FLOAT_VECTOR", "POINT")
    if layer is None:
        return None
    normals = layer_values(layer)
    fixed = np.linalg.norm(normals, axis=1) >= _LEAST
    return np.where(fixed[:, None], normals, np.float32(0)) if fixed.any() else None


def fix(mesh: Mesh, normals: np.ndarray) -> int:
    """Fixes `normals` (n, 3), of length one, at the selected vertices of `mesh`, in Edit Mode; returns
    how many.
    """
    return _mark(mesh, lambda vertex: Vector(normals[vertex.index]))


def fix_along(source: Object, axis: Vector) -> int:
    """The same of the mesh of `source` along `axis`, in the world, to that side to which the mesh
    looks.
    """
    matrix = np.array(world_matrix(source))[:3, :3]
    along = Vector(matrix.T @ np.array(axis)).normalized()

    def towards(vertex: bmesh.types.BMVert) -> Vector:
        return -along if along.dot(vertex.normal) < 0 else along

    return _mark(source.data, towards)


def free(mesh: Mesh) -> int:
    """Leaves the surface free at the selected vertices of `mesh`, in Edit Mode; returns at how many
    of them it was not.
    """
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.verts.layers.float_vector.get(NORMAL)
    if layer is None:
        return 0
    chosen = [v for v in edit.verts if v.select and v[layer].length >= _LEAST]
    for vertex in chosen:
        vertex[layer] = Vector()
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)


def count(sources: Iterable[Object]) -> int:
    """How many normals are fixed, of vertices with faces or without."""
    return sum(shown(source.data, NORMAL, _count, 0) for source in sources)


def _count(mesh: Mesh) -> int:
    if mesh.is_editmode:  # then the mesh lists no values
        edit = bmesh.from_edit_mesh(mesh)
        layer = edit.verts.layers.float_vector.get(NORMAL)
        return 0 if layer is None else sum(v[layer].length >= _LEAST for v in edit.verts)
    normals = read_normals(mesh)
    return 0 if normals is None else int(normals.any(axis=1).sum())


def own_normals(mesh: Mesh) -> np.ndarray:
    """(n, 3) float64 of length one, of a `mesh` that is not in Edit Mode: the mean of those of the
    corners, where somebody chose these.
    """
    if not mesh.has_custom_normals:
        return column(mesh.vertex_normals, "vector", width=3).astype(float)
    corners = column(mesh.loops, "vertex_index", np.int32)
    sums = np.zeros((len(mesh.vertices), 3))
    np.add.at(sums, corners, column(mesh.corner_normals, "vector", width=3).astype(float))
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.divide(sums, length, out=np.zeros_like(sums), where=length > 0)


def _mark(mesh: Mesh, normal_of: Callable[[bmesh.types.BMVert], Vector]) -> int:
    edit = bmesh.from_edit_mesh(mesh)
    if not any(v.select for v in edit.verts):
        return 0
    layer = edit.verts.layers.float_vector.get(NORMAL)
    if layer is None:  # makes all vertices from before invalid
        layer = edit.verts.layers.float_vector.new(NORMAL)
    edit.normal_update()
    edit.verts.index_update()
    chosen = [v for v in edit.verts if v.select and v.link_faces]
    for vertex in chosen:
        vertex[layer] = normal_of(vertex)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)
