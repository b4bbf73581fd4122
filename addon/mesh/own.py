# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of a faired surface that stay when it is recomputed.

Its own data are the vertex groups, attributes, UV maps, colours, marks and shape keys that do not have
a name from the source. Materials, custom properties and modifiers stay anyway.
"""

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ..blender import Mesh, Object
from ..words import listed
from .groups import VertexGroup, read_groups, write_group
from .layers import (
    EDGE_MARKS,
    FACE_MARKS,
    Attribute,
    SurfaceData,
    fill_layer,
    make_layer,
    read_attributes,
    read_marks,
)
from .read import read_mesh
from .samples import Samples
from .shape_keys import KeyAnimation, ShapeKey, ShapeKeys, add_shape_key, read_shape_keys

# from its creases and settings, always replaced
_MADE_ANEW = {"sharp_edge", "sharp_face"}
_OURS = ("fair_", "Fairing ")  # prefixes of the add-on's attributes

Names = dict[str, list[str]]  # names by kind


def carried_names(data: SurfaceData, keys: ShapeKeys | None) -> Names:
    """The names of data that a surface has from its source."""
    return {
        "attributes": [attribute.name for attribute in data.attributes],
        "groups": [group.name for group in data.groups],
        "marks": [*data.edge_marks, *data.face_marks],
        "keys": [key.name for key in keys.keys] if keys else [],
    }


@dataclass(frozen=True)
class OwnData:
    """The surface's own data, read before its mesh is replaced."""

    mesh: Any  # its ControlArrays
    attributes: list[Attribute]
    marks: dict[str, np.ndarray]
    groups: list[VertexGroup]
    active_group: str
    active_uv: str
    active_color: str
    # key, its relative key, (n, 3) difference from that
    keys: list[tuple[ShapeKey, str, np.ndarray]]
    animation: KeyAnimation | None
    notes: list[str]

    def write_keys(self, target: Object, last: bool = True) -> list[str]:
        """Gives `target` the shape keys; returns what is lost. `last`: no other call follows."""
        samples = Samples(self.mesh, read_mesh(target.data)) if self.keys else None
        for key, relative, away in self.keys:
            assert samples is not None
            add_shape_key(target, key, relative, samples.values(away, "POINT", True))
        return self.animation.give(target, last) if self.animation else []

    def drop(self) -> None:
        if self.animation:
            self.animation.drop()


def read_own(target: Object, *carried: Names) -> OwnData | None:
    """Data of the surface in Object Mode that are not `carried` from its source; or None."""
    mesh = target.data
    taken = {
        kind: {name for names in carried for name in names.get(kind, [])}
        for kind in ("attributes", "groups", "marks", "keys")
    }
    known, unknown = read_attributes(mesh)
    attributes = [
        a
        for a in known
        if a.name not in taken["attributes"] | _MADE_ANEW and not a.name.startswith(_OURS)
    ]
    marks = read_marks(mesh.edges, EDGE_MARKS) | read_marks(mesh.polygons, FACE_MARKS)
    names = [group.name for group in target.vertex_groups if group.name not in taken["groups"]]
    groups = read_groups(target, mesh) if names else []
    keys = _own_keys(target, taken["keys"])
    animation = KeyAnimation.of(mesh)
    found = OwnData(
        mesh=read_mesh(mesh),
        attributes=attributes,
        marks={name: values for name, values in marks.items() if name not in taken["marks"]},
        groups=[group for group in groups if group.name in names],
        active_group=_name(target.vertex_groups.active),
        active_uv=_name(mesh.uv_layers.active),
        active_color=mesh.attributes.active_color_name,
        keys=keys,
        animation=animation,
        notes=[f"The attribute '{name}' of the surface is dropped." for name in unknown],
    )
    return found if attributes or found.marks or names or keys or animation else None


def write_own(target: Object, own: OwnData, in_handler: bool = False) -> list[str]:
    """Gives `target` its own data, no keys in a handler; returns what is lost, in sentences."""
    mesh = target.data
    samples = Samples(own.mesh, read_mesh(mesh))
    lost = [a.name for a in own.attributes if a.domain == "EDGE" and not samples.same]
    for attribute in own.attributes:
        if attribute.name not in lost:
            layer = make_layer(mesh, attribute.name, attribute.data_type, attribute.domain)
            fill_layer(layer, samples.of(attribute))
    lost += _write_marks(mesh, own, samples)
    for group in own.groups:
        weights = samples.values(group.dense(len(own.mesh.positions)), "POINT", True)
        zero = group.vertices[group.weights == 0.0] if samples.same else np.empty(0, np.int32)
        write_group(target, group, weights, zero, operators=not in_handler)
    _choose_active(target, own)
    notes = own.notes + ([] if in_handler else own.write_keys(target))
    if lost:
        notes.append(f"{_listed(lost)} dropped: the surface has other edges now.")
    moved = [attribute.name for attribute in own.attributes if attribute.name not in lost]
    moved += [group.name for group in own.groups] + [key.name for key, *_ in own.keys]
    if moved and not samples.same:
        notes.append(f"{_listed(moved)} carried over from the nearest places of the old surface.")
    return notes


def _own_keys(target: Object, taken: set[str]) -> list[tuple[ShapeKey, str, np.ndarray]]:
    keys = read_shape_keys(target, len(target.data.vertices))
    if keys is None:
        return []
    return [
        (
            key,
            keys.keys[key.relative_key].name,
            keys.positions[place] - keys.positions[key.relative_key],
        )
        for place, key in enumerate(keys.keys)
        if place and key.name not in taken
    ]


def _write_marks(mesh: Mesh, own: OwnData, samples: Samples) -> list[str]:
    if not samples.same:
        return [name.removeprefix("use_") for name in own.marks]
    for name, values in own.marks.items():
        elements: Any = mesh.edges if name in EDGE_MARKS else mesh.polygons
        elements.foreach_set(name, values)
    return []


def _choose_active(target: Object, own: OwnData) -> None:
    """Keeps the active elements active, if they are the surface's own."""
    mesh, names = target.data, {attribute.name for attribute in own.attributes}
    if own.active_uv in names:
        mesh.uv_layers.active = mesh.uv_layers[own.active_uv]
    if own.active_color in names:
        mesh.attributes.active_color_name = own.active_color
    if own.active_group in {group.name for group in own.groups}:
        target.vertex_groups.active_index = target.vertex_groups[own.active_group].index


def _name(item: bpy.types.bpy_struct | None) -> str:
    return getattr(item, "name", "")


def _listed(names: list[str]) -> str:
    """For example `'A' and 'B' are`."""
    quoted = listed([f"'{name}'" for name in names])
    return f"{quoted} are" if len(names) > 1 else f"{quoted} is"
