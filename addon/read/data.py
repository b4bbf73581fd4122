# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything on a Blender mesh that is neither shape nor topology, as arrays that outlive the mesh."""

from dataclasses import dataclass

import numpy as np

from .attributes import Attribute, read_attributes
from .groups import VertexGroup, read_groups
from .shape_keys import ShapeKeys, read_shape_keys

EDGE_MARKS = ("use_seam", "use_freestyle_mark")  # properties: the names of their attributes differ by version
FACE_MARKS = ("use_freestyle_mark",)


@dataclass(frozen=True)
class SurfaceData:
    """What can be carried over from a control mesh of n vertices, e edges, m faces and c corners."""

    attributes: list[Attribute]
    edge_marks: dict[str, np.ndarray]  # property → (e,) bool; only those that mark any
    face_marks: dict[str, np.ndarray]  # property → (m,) bool
    active_uv: str  # names; empty: none
    render_uv: str
    active_color: str
    default_color: str
    groups: list[VertexGroup]
    active_group: int
    shape_keys: ShapeKeys | None
    notes: list[str]  # what is lost, a sentence each


def read_data(source, mesh, evaluated=False):
    """SurfaceData of `mesh` (bpy.types.Mesh), which is that of the object `source`, a copy of it from Edit Mode, or,
    `evaluated`, what its modifiers make of it: then its shape keys are in the shape already."""
    attributes, unknown = read_attributes(mesh)
    shape_keys = None if evaluated else read_shape_keys(source, len(mesh.vertices))
    return SurfaceData(
        attributes=attributes,
        edge_marks=_marks(mesh.edges, EDGE_MARKS),
        face_marks=_marks(mesh.polygons, FACE_MARKS),
        active_uv=mesh.uv_layers.active.name if mesh.uv_layers.active else "",
        render_uv=next((layer.name for layer in mesh.uv_layers if layer.active_render), ""),
        active_color=mesh.attributes.active_color_name,
        default_color=mesh.attributes.default_color_name,
        groups=read_groups(source, mesh),
        active_group=source.vertex_groups.active_index,
        shape_keys=shape_keys,
        notes=_losses(source, mesh, unknown, evaluated, shape_keys),
    )


def _marks(elements, names):
    found = {}
    for name in names:
        # Blender may be built without Freestyle
        if len(elements) and name in elements[0].bl_rna.properties:
            values = np.empty(len(elements), bool)
            elements.foreach_get(name, values)
            if values.any():
                found[name] = values
    return found


def _losses(source, mesh, unknown, evaluated, shape_keys):
    notes = []
    if mesh.has_custom_normals:
        notes.append("Custom normals are dropped: the refined surface has its own.")
    if len(mesh.skin_vertices):
        notes.append("Skin sizes are dropped: they belong to the edges of the control mesh.")
    for name in unknown:
        notes.append(f"The attribute '{name}' is dropped: its type is not known.")
    loose = np.ones(len(mesh.edges), bool)
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    loose[edges] = False
    if loose.any():
        notes.append("Edges without a face are left out: they carry no surface.")
    keys = source.data.shape_keys
    if keys is None or evaluated:
        return notes
    if shape_keys is None:
        notes.append("Shape keys are dropped: they do not fit the mesh.")
    elif keys.animation_data is not None and keys.animation_data.action is not None:
        notes.append("The animation of the shape keys is not copied; their values and drivers are.")
    return notes
