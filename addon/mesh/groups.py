# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex groups as arrays, read and written.

Blender reads and writes weights one by one: reading a million takes a second. For writing there is an
operator that converts an attribute to a group: 30 ms for half a million weights instead of a second.
"""

from dataclasses import dataclass
from itertools import chain

import bpy
import numpy as np

from ..blender import Mesh, Object

_PASSING = "discrete_fairing_weight"


@dataclass(frozen=True)
class VertexGroup:
    """A group with g members; a member may have the weight 0."""

    name: str
    lock_weight: bool
    vertices: np.ndarray  # (g,) int32
    weights: np.ndarray  # (g,) float32
    count: int  # of all vertices

    @property
    def dense(self) -> np.ndarray:
        """(count,) float32: the weight of every vertex, 0 outside the group."""
        weights = np.zeros(self.count, np.float32)
        weights[self.vertices] = self.weights
        return weights


def read_groups(source: Object, mesh: Mesh) -> list[VertexGroup]:
    """The vertex groups of the object `source`, with their members in `mesh`."""
    groups = source.vertex_groups
    if not len(groups):
        return []
    flat = chain.from_iterable(
        (v.index, g.group, g.weight) for v in mesh.vertices for g in v.groups
    )
    vertex, group, weight = np.fromiter(flat, np.float64).reshape(-1, 3).T
    order = np.argsort(group, kind="stable")
    starts = np.searchsorted(group[order], np.arange(len(groups) + 1))
    return [
        VertexGroup(
            g.name,
            g.lock_weight,
            vertex[order[begin:end]].astype(np.int32),
            weight[order[begin:end]].astype(np.float32),
            len(mesh.vertices),
        )
        for g, begin, end in zip(groups, starts, starts[1:])
    ]


def write_group(
    target: Object, group: VertexGroup, weights: np.ndarray, keeps_ids: bool, operators: bool = True
) -> None:
    """Gives `target`, in Object Mode, a copy of `group` with `weights` (N,). `keeps_ids`: whether members have the same
    ids there; `operators`: not within handlers.
    """
    make = _convert if operators and weights.any() else _add
    made = make(target, weights)
    made.name = group.name
    zero = group.vertices[group.weights == 0.0]
    if keeps_ids and len(zero):  # the operator drops them, but they are members
        made.add(zero.tolist(), 0.0, "REPLACE")
    made.lock_weight = group.lock_weight


def _add(target: Object, weights: np.ndarray) -> bpy.types.VertexGroup:
    """A new vertex group of the `weights` (N,) other than 0, added by equal weight."""
    made = target.vertex_groups.new()
    members = np.flatnonzero(weights)
    members = members[np.argsort(weights[members], kind="stable")]
    found, starts = np.unique(weights[members], return_index=True)
    for weight, ids in zip(found.tolist(), np.split(members, starts[1:])):
        made.add(ids.tolist(), weight, "REPLACE")
    return made


def _convert(target: Object, weights: np.ndarray) -> bpy.types.VertexGroup:
    """A new vertex group of `weights` (N,) other than 0; no object may be in Edit Mode."""
    attribute = target.data.attributes.new(_PASSING, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.clip(weights, 0.0, 1.0))
    target.data.attributes.active = attribute
    with bpy.context.temp_override(object=target, active_object=target, edit_object=None):
        bpy.ops.geometry.attribute_convert(mode="VERTEX_GROUP")
    return target.vertex_groups[-1]
