# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixed normals of the surface at vertices: a vector attribute on points, of unit length, in the
coordinates of the object. Shorter vectors, and no attribute, fix nothing; so on new vertices Blender's
mix of a fixed normal and none fixes nothing.
"""

from collections.abc import Iterable

import bmesh
import numpy as np
from mathutils import Vector

from ..blender import Mesh, Object, column
from .layers import find_layer, layer_values
from .mesh_changes import shown

NORMAL = "fair_normal"

_LEAST = 0.999  # least length: single precision and mixing of equal normals reduce it slightly


def read_normals(mesh: Mesh) -> np.ndarray | None:
    """(n, 3) float32, zero at free vertices; None if all are free. `mesh` is not in Edit Mode."""
    layer = find_layer(mesh, NORMAL, "FLOAT_VECTOR", "POINT")
    if layer is None:
        return None
    normals = layer_values(layer)
    fixed = np.linalg.norm(normals, axis=1) >= _LEAST
    return np.where(fixed[:, None], normals, np.float32(0)) if fixed.any() else None


def fix(mesh: Mesh, normals: np.ndarray) -> int:
    """Fixes unit `normals` (n, 3) at selected vertices, in Edit Mode; returns their number."""
    edit = bmesh.from_edit_mesh(mesh)
    if not any(v.select for v in edit.verts):
        return 0
    layer = edit.verts.layers.float_vector.get(NORMAL)
    if layer is None:  # this invalidates references to vertices
        layer = edit.verts.layers.float_vector.new(NORMAL)
    edit.normal_update()
    edit.verts.index_update()
    chosen = [v for v in edit.verts if v.select and v.link_faces]
    for vertex in chosen:
        vertex[layer] = Vector(normals[vertex.index])
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)


def free(mesh: Mesh) -> int:
    """Removes the fixed normals at the selected vertices of `mesh`, in Edit Mode; returns their number."""
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
    """Number of fixed normals, at vertices with or without faces."""
    return sum(shown(source.data, NORMAL, _count, 0) for source in sources)


def _count(mesh: Mesh) -> int:
    if mesh.is_editmode:  # the mesh lists no values in Edit Mode
        edit = bmesh.from_edit_mesh(mesh)
        layer = edit.verts.layers.float_vector.get(NORMAL)
        return 0 if layer is None else sum(v[layer].length >= _LEAST for v in edit.verts)
    normals = read_normals(mesh)
    return 0 if normals is None else int(normals.any(axis=1).sum())


def own_normals(mesh: Mesh) -> np.ndarray:
    """(n, 3) mean corner normals, custom ones included, of a `mesh` not in Edit Mode."""
    if not mesh.has_custom_normals:
        return column(mesh.vertex_normals, "vector", width=3).astype(float)
    corners = column(mesh.loops, "vertex_index", np.int32)
    sums = np.zeros((len(mesh.vertices), 3))
    np.add.at(sums, corners, column(mesh.corner_normals, "vector", width=3).astype(float))
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.divide(sums, length, out=np.zeros_like(sums), where=length > 0)
