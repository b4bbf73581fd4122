# SPDX-License-Identifier: GPL-3.0-or-later
"""What users mark on elements of a mesh, as attributes: the boundary of single border edges, fixed normals,
faces to keep flat.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

import bmesh
import numpy as np

from ..blender import Mesh, Object, column
from ..choices import EDGE_BOUNDARIES
from ..triangles import unit
from .layers import fill_layer, layer_values, make_layer, values_of_layer
from .mesh_changes import shown


@dataclass(frozen=True)
class Mark:
    """An attribute; elements with the value 0 are not marked."""

    name: str
    data_type: str
    domain: str


# numbered as in choices.EDGE_BOUNDARIES; at 0 the surface's setting applies
BOUNDARY = Mark("fair_boundary", "INT", "EDGE")
# Unit vectors in the coordinates of the object. Shorter ones fix nothing; so on new vertices Blender's mix of a
# fixed normal and none fixes nothing.
NORMAL = Mark("fair_normal", "FLOAT_VECTOR", "POINT")
FLAT = Mark("fair_flat", "BOOLEAN", "FACE")

_LEAST = 0.999  # least length: single precision and mixing of equal normals reduce it slightly
_OF_BMESH = {"INT": "int", "FLOAT_VECTOR": "float_vector", "BOOLEAN": "bool"}
_ELEMENTS = {"POINT": "verts", "EDGE": "edges", "FACE": "faces"}


def read(mesh: Mesh, mark: Mark) -> np.ndarray | None:
    """The values of all elements, of normals (n, 3), in either mode; None if no element has one."""
    if not mesh.is_editmode:
        values = values_of_layer(mesh, mark.name, mark.data_type, mark.domain)
    else:  # the mesh lists none then; nor does BMesh those of faces in Blender 4.3 and 4.4
        elements = getattr(bmesh.from_edit_mesh(mesh), _ELEMENTS[mark.domain])
        layers = getattr(elements.layers, _OF_BMESH[mark.data_type], {})
        layer = layers.get(mark.name)
        values = None if layer is None else np.array([element[layer] for element in elements])
    if values is not None and mark == NORMAL:
        fixed = np.linalg.norm(values, axis=-1) >= _LEAST
        values = np.where(fixed[:, None], values, np.float32(0))
    return values if values is not None and values.any() else None


def put(mesh: Mesh, mark: Mark, chosen: np.ndarray, values: np.ndarray | int) -> int:
    """Gives `chosen` elements, (k,) bool, of a mesh in Object Mode their `values`: one for all, or (k, …). Returns
    their number.
    """
    if chosen.any():
        layer = make_layer(mesh, mark.name, mark.data_type, mark.domain)
        known = layer_values(layer)
        known[chosen] = values if np.ndim(values) == 0 else np.asarray(values)[chosen]
        if known.any():
            fill_layer(layer, known)
        else:
            mesh.attributes.remove(layer)
        mesh.update()
    return int(chosen.sum())


def marked(mesh: Mesh, mark: Mark) -> np.ndarray:
    """(k,) bool: the marked elements."""
    values = read(mesh, mark)
    if values is None:
        return np.zeros(mesh.attributes.domain_size(mark.domain), bool)
    return values.any(axis=1) if values.ndim > 1 else values != 0


def count(sources: Iterable[Object], mark: Mark) -> int:
    """Number of marked elements; 0 in Edit Mode where Blender does not show the attribute."""
    measure = partial(_count, mark=mark)
    return sum(shown(source.data, mark, measure, 0) for source in sources)


def _count(mesh: Mesh, mark: Mark) -> int:
    return int(marked(mesh, mark).sum())


def boundaries_text(sources: Iterable[Object]) -> str:
    """For example `Edges: 8 Straight, 4 Free`; empty if no border edge has its own boundary."""
    none = np.zeros(len(EDGE_BOUNDARIES), int)
    total = sum((shown(source.data, BOUNDARY, _boundaries, none) for source in sources), none)
    parts = [
        f"{total[number]} {name}"
        for _, name, _, number in EDGE_BOUNDARIES
        if number and total[number]
    ]
    return "Edges: " + ", ".join(parts) if parts else ""


def _boundaries(mesh: Mesh) -> np.ndarray:
    values, count = read(mesh, BOUNDARY), len(EDGE_BOUNDARIES)
    if values is None:
        return np.zeros(count, int)
    values = values[border_edges(mesh) & (values >= 0) & (values < count)]
    return np.bincount(values, minlength=count)


def border_edges(mesh: Mesh) -> np.ndarray:
    """(e,) bool: the edges with one face, in either mode."""
    if mesh.is_editmode:
        return np.array([edge.is_boundary for edge in bmesh.from_edit_mesh(mesh).edges], bool)
    return np.bincount(column(mesh.loops, "edge_index", np.int32), minlength=len(mesh.edges)) == 1


def own_normals(mesh: Mesh) -> np.ndarray:
    """(n, 3) mean corner normals, custom ones included, of a mesh in Object Mode; zero at vertices without faces."""
    corners = column(mesh.loops, "vertex_index", np.int32)
    normals = column(mesh.corner_normals, "vector", width=3)
    if not mesh.has_custom_normals:
        normals = column(mesh.vertex_normals, "vector", width=3)[corners]
    sums = np.zeros((len(mesh.vertices), 3))
    np.add.at(sums, corners, normals)
    return unit(sums)
