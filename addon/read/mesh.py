# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender mesh as NumPy arrays, copied in bulk: no Python object per element is ever made."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ControlArrays:
    """A control mesh of n vertices, e edges, m faces and c face corners."""

    positions: np.ndarray  # (n, 3) float64
    edges: np.ndarray  # (e, 2) int32, vertex pairs
    corners: np.ndarray  # (c,) int32, vertices of the faces, face after face
    corner_edges: np.ndarray  # (c,) int32, the edge that leaves each corner
    offsets: np.ndarray  # (m + 1,) int32: face f has the corners offsets[f] … offsets[f + 1] - 1
    edge_crease: np.ndarray | None  # (e,) float32
    vertex_crease: np.ndarray | None  # (n,) float32
    sharp_edge: np.ndarray | None  # (e,) bool

    @property
    def face_sizes(self):
        """(m,) int32: corners of each face."""
        return self.offsets[1:] - self.offsets[:-1]


def read_mesh(mesh):
    """`mesh` (bpy.types.Mesh, not in Edit Mode) as ControlArrays."""
    vertices, edges, corners, faces = len(mesh.vertices), len(mesh.edges), len(mesh.loops), len(mesh.polygons)
    return ControlArrays(
        positions=_required(mesh, "position", "POINT", "FLOAT_VECTOR", 3 * vertices)
        .reshape(-1, 3)
        .astype(np.float64),
        edges=_required(mesh, ".edge_verts", "EDGE", "INT32_2D", 2 * edges).reshape(-1, 2),
        corners=_required(mesh, ".corner_vert", "CORNER", "INT", corners),
        corner_edges=_required(mesh, ".corner_edge", "CORNER", "INT", corners),
        offsets=_offsets(mesh, faces, corners),
        edge_crease=_optional(mesh, "crease_edge", "EDGE", "FLOAT", edges),
        vertex_crease=_optional(mesh, "crease_vert", "POINT", "FLOAT", vertices),
        sharp_edge=_optional(mesh, "sharp_edge", "EDGE", "BOOLEAN", edges),
    )


# Attribute type: the name of its value in foreach_get, and how Blender stores it.
_STORAGE = {
    "FLOAT_VECTOR": ("vector", np.float32),
    "FLOAT": ("value", np.float32),
    "INT": ("value", np.int32),
    "INT32_2D": ("value", np.int32),
    "BOOLEAN": ("value", bool),
}


def _optional(mesh, name, domain, data_type, size):
    """The named attribute, or None. Blender accepts any domain and type under any name, so both are checked."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != domain or attribute.data_type != data_type:
        return None
    value, dtype = _STORAGE[data_type]
    values = np.empty(size, dtype)
    attribute.data.foreach_get(value, values)
    return values


def _required(mesh, name, domain, data_type, size):
    """Part of every mesh, but not listed while it is empty."""
    values = _optional(mesh, name, domain, data_type, size)
    if values is None and size:
        raise RuntimeError(f"The mesh '{mesh.name}' has no attribute '{name}' ({data_type} on {domain})")
    return np.empty(0, _STORAGE[data_type][1]) if values is None else values


def _offsets(mesh, faces, corners):
    offsets = np.empty(faces + 1, np.int32)
    mesh.polygons.foreach_get("loop_start", offsets[:-1])
    offsets[-1] = corners
    return offsets
