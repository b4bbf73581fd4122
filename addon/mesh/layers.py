# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of a mesh besides shape and topology: read as arrays, written to another mesh."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..blender import Mesh, Object, column
from ..transfer.attributes import AttributeTransfer
from .groups import VertexGroup, read_groups, write_group
from .shape_keys import ShapeKeys, read_shape_keys

# by domain; properties, since the names of their attributes differ by version
_MARKS = {"EDGE": ("use_seam", "use_freestyle_mark"), "FACE": ("use_freestyle_mark",)}
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


class Carrier(Protocol):
    """Carries values from one mesh over to another."""

    keeps_ids: bool  # whether vertices of the first mesh have the same ids in the other

    def of(self, attribute: Attribute) -> np.ndarray | None:
        """The values on the other mesh; None if its elements do not correspond to those of the first."""


class Refined:
    """Carries values of a control mesh over to the refined `mesh`."""

    keeps_ids = True

    def __init__(self, transfer: AttributeTransfer, mesh: Mesh) -> None:
        # an attribute is written as a block, and is not listed if missing
        corners = mesh.attributes.get(".corner_edge")
        edges = np.empty(0, np.int32) if corners is None else layer_values(corners)
        self._transfer = transfer
        self._origin = transfer.edge_origin(edges, len(mesh.edges))

    def of(self, attribute: Attribute) -> np.ndarray:
        transfer, values = self._transfer, attribute.values
        mixable = STORAGE[attribute.data_type].mixable
        if attribute.domain == "EDGE":  # of the pieces of control edges; 0 or False on all others
            found = self._origin >= 0
            out = np.zeros((len(found), *values.shape[1:]), values.dtype)
            out[found] = values[self._origin[found]]
            return out
        if attribute.domain == "FACE":
            return transfer.face(values)
        if attribute.domain == "CORNER":
            return transfer.corner(values) if mixable else transfer.pick_corner(values)
        if attribute.name in OWN_VERTICES_ONLY:
            return transfer.own_point(values)
        return transfer.point(values) if mixable else transfer.pick_point(values)


Names = Mapping[str, Collection[str]]  # names by kind: attributes, groups, marks, keys
_NONE: Names = {}


@dataclass(frozen=True)
class SurfaceData:
    """The transferable data of a mesh with n vertices, e edges, m faces and c corners."""

    attributes: list[Attribute]
    marks: list[Attribute]  # properties of edges and faces that mark some
    active_uv: str  # names; empty: none
    render_uv: str
    active_color: str
    default_color: str
    groups: list[VertexGroup]
    active_group: str
    shape_keys: ShapeKeys | None
    unknown: list[str]  # names of attributes of unknown types, which are lost
    notes: list[str]  # what a refined surface loses, a sentence each


def read_data(
    source: Object, mesh: Mesh, evaluated: bool = False, taken: Names = _NONE
) -> SurfaceData:
    """SurfaceData of `mesh` (bpy.types.Mesh): the mesh of the object `source`, a copy of it from Edit
    Mode, or, `evaluated`, the result of its modifiers, whose shape contains the shape keys already. Without data
    with names that are `taken`.
    """
    attributes, unknown = read_attributes(mesh)
    shape_keys = None if evaluated else read_shape_keys(source, len(mesh.vertices))
    groups = [g.name for g in source.vertex_groups if g.name not in taken.get("groups", ())]
    return SurfaceData(
        attributes=[a for a in attributes if a.name not in taken.get("attributes", ())],
        marks=[mark for mark in _read_marks(mesh) if mark.name not in taken.get("marks", ())],
        active_uv=mesh.uv_layers.active.name if mesh.uv_layers.active else "",
        render_uv=next((layer.name for layer in mesh.uv_layers if layer.active_render), ""),
        active_color=mesh.attributes.active_color_name,
        default_color=mesh.attributes.default_color_name,
        groups=[g for g in read_groups(source, mesh) if g.name in groups] if groups else [],
        active_group=source.vertex_groups.active.name if source.vertex_groups.active else "",
        shape_keys=shape_keys,
        unknown=unknown,
        notes=_losses(source, mesh, unknown, evaluated, shape_keys),
    )


def _elements(mesh: Mesh, domain: str) -> Any:
    return mesh.edges if domain == "EDGE" else mesh.polygons


def _read_marks(mesh: Mesh) -> list[Attribute]:
    found = []
    for domain, names in _MARKS.items():
        elements = _elements(mesh, domain)
        for name in names:
            # Blender may be built without Freestyle
            if len(elements) and name in elements[0].bl_rna.properties:
                values = column(elements, name, bool)
                if values.any():
                    found.append(Attribute(name, "BOOLEAN", domain, values))
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


def write_data(
    target: Object,
    data: SurfaceData,
    carrier: Carrier,
    leave_out: Collection[str] = (),
    operators: bool = True,
) -> list[str]:
    """Gives the object `target`, in Object Mode, the `data` of another mesh; returns the names of data that are lost.

    `operators`: see groups.py. Attributes named in `leave_out` are not written. Sharp edges are added
    to existing ones. Shape keys: see shape_keys.py; they come last, since attributes of a mesh with
    shape keys are harder to change.
    """
    mesh, lost = target.data, []
    for attribute in data.attributes:
        values = None if attribute.name in leave_out else carrier.of(attribute)
        if values is not None:
            _write_attribute(mesh, attribute, values)
        elif attribute.name not in leave_out:
            lost.append(attribute.name)
    for mark in data.marks:
        values = carrier.of(mark)
        if values is not None:
            _elements(mesh, mark.domain).foreach_set(mark.name, values)
        else:
            lost.append(mark.name.removeprefix("use_"))
    for group in data.groups:
        weights = carrier.of(Attribute(group.name, "FLOAT", "POINT", group.dense))
        assert weights is not None  # of vertices
        write_group(target, group, weights.ravel(), carrier.keeps_ids, operators)
    _choose_active(target, data)
    mesh.update()
    return lost


def _write_attribute(mesh: Mesh, attribute: Attribute, values: np.ndarray) -> None:
    layer = make_layer(mesh, attribute.name, attribute.data_type, attribute.domain)
    if attribute.name == "sharp_edge":  # in addition to the surface's own creases
        values = values | layer_values(layer)
    fill_layer(layer, values)


def _choose_active(target: Object, data: SurfaceData) -> None:
    """What was active in the `data` is active again; last, since new ones become active."""
    mesh, names = target.data, {attribute.name for attribute in data.attributes}
    maps = names & set(mesh.uv_layers.keys())  # without faces there is none
    if data.active_uv in maps:
        mesh.uv_layers.active = mesh.uv_layers[data.active_uv]
    if data.render_uv in maps:
        mesh.uv_layers[data.render_uv].active_render = True
    if data.active_color in names:
        mesh.attributes.active_color_name = data.active_color
    if data.default_color in names:
        mesh.attributes.default_color_name = data.default_color
    if data.active_group in {group.name for group in data.groups}:
        target.vertex_groups.active_index = target.vertex_groups[data.active_group].index
