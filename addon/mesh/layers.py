# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of a mesh besides shape and topology: read as arrays, written to the refined mesh."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..blender import Mesh, Object, column
from ..transfer.attributes import AttributeTransfer
from .groups import VertexGroup, read_groups, write_groups
from .shape_keys import ShapeKeys, read_shape_keys

# properties, since the names of their attributes differ by version
EDGE_MARKS = ("use_seam", "use_freestyle_mark")
FACE_MARKS = ("use_freestyle_mark",)
# A crease or bevel weight applies to one vertex; interpolated over the faces around it, it would apply
# everywhere.
OWN_VERTICES_ONLY = {"crease_vert", "bevel_weight_vert"}


@dataclass(frozen=True)
class Storage:
    """How Blender stores an element of a data type."""

    field: str  # its name in foreach_get and foreach_set
    dtype: Any
    width: int
    mixable: bool  # whether a mean of values makes sense


STORAGE = {
    "FLOAT": Storage("value", np.float32, 1, True),
    "FLOAT2": Storage("vector", np.float32, 2, True),
    "FLOAT_VECTOR": Storage("vector", np.float32, 3, True),
    "FLOAT_COLOR": Storage("color", np.float32, 4, True),
    "BYTE_COLOR": Storage("color", np.float32, 4, True),  # linear colours, which mix like light
    "INT": Storage("value", np.int32, 1, False),
    "INT8": Storage("value", np.int32, 1, False),
    "INT16_2D": Storage("value", np.int32, 2, False),
    "INT32_2D": Storage("value", np.int32, 2, False),
    "BOOLEAN": Storage("value", bool, 1, False),
    "QUATERNION": Storage("value", np.float32, 4, False),
    "FLOAT4X4": Storage("value", np.float32, 16, False),
    "STRING": Storage("value", object, 1, False),
}

# positions and topology, which the refined mesh has itself; seams have another name in each version of
# Blender
OFFSET_NAMES = "fair_offset"  # of vertices named by a table of offsets
_NOT_CARRIED = {"position", "custom_normal", "uv_seam", OFFSET_NAMES}
# other names that begin with a dot are Blender's own: topology, selection, visibility, pins
_INTERNAL_CARRIED = {".sculpt_mask", ".sculpt_face_set"}


@dataclass(frozen=True)
class Attribute:
    """One attribute: `values` (size,) or (size, width) on the elements of `domain`."""

    name: str
    data_type: str
    domain: str
    values: np.ndarray


def find_layer(mesh: Mesh, name: str, data_type: str, domain: str) -> Any:
    """The named attribute, or None; Blender accepts any domain and type under any name."""
    layer = mesh.attributes.get(name)
    if layer is None or (layer.data_type, layer.domain) != (data_type, domain):
        return None
    return layer


def make_layer(mesh: Mesh, name: str, data_type: str, domain: str) -> Any:
    """The named attribute; created, in place of another of that name, if missing."""
    layer = find_layer(mesh, name, data_type, domain)
    if layer is not None:
        return layer
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, data_type, domain)
    return mesh.attributes[name]


def layer_values(layer: Any) -> np.ndarray:
    """(size,) or (size, width): a copy of the values of a bpy.types.Attribute."""
    storage = STORAGE[layer.data_type]
    size = len(layer.data)
    if storage.dtype is object:  # texts have no bulk access
        values = np.array([item.value for item in layer.data], object)
    else:
        values = np.empty(size * storage.width, storage.dtype)
        layer.data.foreach_get(storage.field, values)
    return values.reshape(size, storage.width) if storage.width > 1 else values


def values_of_layer(mesh: Mesh, name: str, data_type: str, domain: str) -> np.ndarray | None:
    """The values of the named attribute; None without it."""
    layer = find_layer(mesh, name, data_type, domain)
    return None if layer is None else layer_values(layer)


def fill_layer(layer: Any, values: np.ndarray) -> None:
    """Writes values in the format of `layer_values`."""
    storage = STORAGE[layer.data_type]
    if storage.dtype is object:
        for i in np.flatnonzero(values.astype(bool)).tolist():
            layer.data[i].value = values[i]
    else:
        layer.data.foreach_set(storage.field, np.ascontiguousarray(values, storage.dtype).ravel())


def write_creases(mesh: Mesh, weights: Mapping[frozenset[int], float]) -> None:
    """Sets the creases of edges, given by their two vertices; all others get none."""
    values = [weights.get(frozenset(edge.vertices), 0.0) for edge in mesh.edges]
    fill_layer(make_layer(mesh, "crease_edge", "FLOAT", "EDGE"), np.array(values))


def read_attributes(mesh: Mesh) -> tuple[list[Attribute], list[str]]:
    """The attributes of `mesh` to transfer, and the names of those with unknown data types."""
    chosen = [attribute for attribute in mesh.attributes if _is_carried(attribute.name)]
    known = [attribute for attribute in chosen if attribute.data_type in STORAGE]
    return [Attribute(a.name, a.data_type, a.domain, layer_values(a)) for a in known], [
        a.name for a in chosen if a.data_type not in STORAGE
    ]


def _is_carried(name: str) -> bool:
    return name not in _NOT_CARRIED and (not name.startswith(".") or name in _INTERNAL_CARRIED)


@dataclass(frozen=True)
class SurfaceData:
    """The transferable data of a control mesh with n vertices, e edges, m faces and c corners."""

    attributes: list[Attribute]
    edge_marks: dict[str, np.ndarray]  # property → (e,) bool; only properties that mark an edge
    face_marks: dict[str, np.ndarray]  # property → (m,) bool
    active_uv: str  # names; empty: none
    render_uv: str
    active_color: str
    default_color: str
    groups: list[VertexGroup]
    active_group: int
    shape_keys: ShapeKeys | None
    notes: list[str]  # what is lost, a sentence each


def read_data(source: Object, mesh: Mesh, evaluated: bool = False) -> SurfaceData:
    """SurfaceData of `mesh` (bpy.types.Mesh): the mesh of the object `source`, a copy of it from Edit
    Mode, or, `evaluated`, the result of its modifiers, whose shape contains the shape keys already.
    """
    attributes, unknown = read_attributes(mesh)
    shape_keys = None if evaluated else read_shape_keys(source, len(mesh.vertices))
    return SurfaceData(
        attributes=attributes,
        edge_marks=read_marks(mesh.edges, EDGE_MARKS),
        face_marks=read_marks(mesh.polygons, FACE_MARKS),
        active_uv=mesh.uv_layers.active.name if mesh.uv_layers.active else "",
        render_uv=next((layer.name for layer in mesh.uv_layers if layer.active_render), ""),
        active_color=mesh.attributes.active_color_name,
        default_color=mesh.attributes.default_color_name,
        groups=read_groups(source, mesh),
        active_group=source.vertex_groups.active_index or 0,
        shape_keys=shape_keys,
        notes=_losses(source, mesh, unknown, evaluated, shape_keys),
    )


def read_marks(elements: Any, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """(size,) bool for the properties `names` of `elements` of a mesh, without those that mark none."""
    found = {}
    for name in names:
        # Blender may be built without Freestyle
        if len(elements) and name in elements[0].bl_rna.properties:
            values = column(elements, name, bool)
            if values.any():
                found[name] = values
    return found


def _losses(
    source: Object, mesh: Mesh, unknown: list[str], evaluated: bool, shape_keys: ShapeKeys | None
) -> list[str]:
    notes = []
    if mesh.has_custom_normals:
        notes.append("Custom normals are dropped: the refined surface has its own.")
    if len(mesh.skin_vertices):
        notes.append("Skin sizes are dropped: they belong to the edges of the control mesh.")
    for name in unknown:
        notes.append(f"The attribute '{name}' is dropped: its type is not known.")
    if len(np.unique(column(mesh.loops, "edge_index", np.int32))) < len(mesh.edges):
        notes.append("Edges without a face are left out: they carry no surface.")
    keys = source.data.shape_keys
    if keys is None or evaluated:
        return notes
    if shape_keys is None:
        notes.append("Shape keys are dropped: they do not fit the mesh.")
    elif keys.animation_data is not None and keys.animation_data.action is not None:
        notes.append("The animation of the shape keys is not copied; their values and drivers are.")
    return notes


def write_attributes(
    mesh: Mesh,
    attributes: list[Attribute],
    transfer: AttributeTransfer,
    origin: np.ndarray,
    leave_out: Collection[str] = (),
) -> None:
    """Writes `attributes` not in `leave_out`; `origin`: the control edge of refined ones, or -1."""
    for attribute in attributes:
        if attribute.name not in leave_out:
            _write_attribute(mesh, attribute, _carried(attribute, transfer, origin))


def inherit(values: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """(e, …) values of control edges → values of their pieces; 0 or False on all other refined edges."""
    found = origin >= 0
    out = np.zeros((len(origin), *values.shape[1:]), values.dtype)
    out[found] = values[origin[found]]
    return out


def _carried(attribute: Attribute, transfer: AttributeTransfer, origin: np.ndarray) -> np.ndarray:
    values, mixable = attribute.values, STORAGE[attribute.data_type].mixable
    if attribute.domain == "EDGE":
        return inherit(values, origin)
    if attribute.domain == "FACE":
        return transfer.face(values)
    if attribute.domain == "CORNER":
        return transfer.corner(values) if mixable else transfer.pick_corner(values)
    if attribute.name in OWN_VERTICES_ONLY:
        return transfer.own_point(values)
    return transfer.point(values) if mixable else transfer.pick_point(values)


def _write_attribute(mesh: Mesh, attribute: Attribute, values: np.ndarray) -> None:
    layer = make_layer(mesh, attribute.name, attribute.data_type, attribute.domain)
    if attribute.name == "sharp_edge":  # in addition to the surface's own creases
        values = values | layer_values(layer)
    fill_layer(layer, values)


def write_data(
    target: Object,
    data: SurfaceData,
    transfer: AttributeTransfer,
    leave_out: Collection[str] = (),
    operators: bool = True,
) -> None:
    """Gives the object `target`, in Object Mode with the refined mesh, the `data`.

    `operators`: see groups.py. Attributes named in `leave_out` are not written. Sharp edges are added
    to existing ones. Shape keys: see shape_keys.py; they come last, since attributes of a mesh with
    shape keys are harder to change.
    """
    mesh = target.data
    # an attribute is written as a block, and is not listed if missing
    corners = len(mesh.loops)
    edges = layer_values(mesh.attributes[".corner_edge"]) if corners else np.empty(0, np.int32)
    origin = transfer.edge_origin(edges, len(mesh.edges))
    write_attributes(mesh, data.attributes, transfer, origin, leave_out)
    for name, values in data.edge_marks.items():
        mesh.edges.foreach_set(name, inherit(values, origin))
    for name, values in data.face_marks.items():
        mesh.polygons.foreach_set(name, transfer.face(values))
    write_groups(target, data.groups, data.active_group, transfer, operators)
    _choose_active(mesh, data)
    mesh.update()


def _choose_active(mesh: Mesh, data: SurfaceData) -> None:
    """Sets the UV map and colours for display and rendering; last, since new ones become active."""
    if data.active_uv in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[data.active_uv]
    if data.render_uv in mesh.uv_layers:
        mesh.uv_layers[data.render_uv].active_render = True
    mesh.attributes.active_color_name = data.active_color
    mesh.attributes.default_color_name = data.default_color
