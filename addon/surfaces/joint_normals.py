# SPDX-License-Identifier: GPL-3.0-or-later
"""Custom normals at joints: where borders of surfaces meet, each vertex has the normal of its surface.

Blender's own normal there is the mean of the faces on one side, so reflections would break at a joint
without a kink. Other borders keep Blender's: a Mirror or Weld modifier that closes them would spoil custom
normals.
"""

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np

from .. import core, memory
from ..blender import Context, Object, all_objects, column
from ..mesh.read import read_mesh
from ..mesh.world_shape import world_matrix
from . import neighbours


def update(context: Context, target: Object, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    """Gives the surface `target` the normals at its present joints, and takes away those of earlier
    ones. A mesh with the user's custom normals keeps them. `depsgraph`: that of an update in progress.
    """
    mesh = target.data
    ours = mesh.discrete_fairing.joint_normals
    if not mesh.is_editable or target.mode == "EDIT" or (mesh.has_custom_normals and not ours):
        return
    found = None
    if met := list(_met_by(target)):
        way = np.linalg.pinv(np.array(world_matrix(target), np.float64))  # a scale may be zero
        found = _normals(target, [neighbours.shown(context, o, way, depsgraph) for o in met])
    if found is not None:
        mesh.normals_split_custom_set(found)
    elif mesh.has_custom_normals:
        _remove(mesh)
    mesh.discrete_fairing.joint_normals = mesh.has_custom_normals


def _remove(mesh: Any) -> None:
    stored = mesh.attributes.get("custom_normal")
    if stored is not None:
        mesh.attributes.remove(stored)
    else:  # no attribute before Blender 4.5; zero stands for Blender's own normals
        mesh.normals_split_custom_set(np.zeros((len(mesh.loops), 3), np.float32))


def update_others(context: Context, target: Object) -> None:
    """The same for the other surfaces with joints, present or earlier ones, with `target` or another."""
    met = list(_met_by(target))
    for other in all_objects():
        if other.type != "MESH" or other == target or memory.source_of(other) is None:
            continue
        is_free = other.data.discrete_fairing.joint_normals and not any(_met_by(other))
        if other in met or is_free:
            update(context, other)


def _met_by(target: Object) -> Iterator[Object]:
    """The objects that the border of `target` meets: its neighbour, and surfaces whose neighbour it is."""
    for other in all_objects():
        if other.type == "MESH" and other.users_scene:
            known = (neighbours.neighbour_of(target), neighbours.neighbour_of(other))
            if other == known[0] or target == known[1]:
                yield other


def _normals(target: Object, others: list[Any]) -> np.ndarray | None:
    """(c, 3) by corner: the normals at joints with the `others`, elsewhere zero; None without a joint."""
    borders, arrays = core.module().joints.borders, read_mesh(target.data)
    points, offsets = arrays.positions, arrays.offsets.astype(np.int64)
    edge, _ = borders.border_edges(arrays.corners.astype(np.int64), offsets)
    length = np.linalg.norm(points[edge[:, 1]] - points[edge[:, 0]], axis=1)
    vertex = np.unique(edge)
    reach = np.zeros(len(points))
    reach[edge] = core.module().joints.matching.NEAR * length[:, None]
    near = np.zeros(len(vertex), bool)
    for met, (corners, starts) in others:
        if len(borders.border_edges(corners, starts)[0]):
            curve = borders.border_curve(met, corners, starts)
            feet = curve.between(curve.point, *curve.feet(points[vertex])[:2])
            near |= np.linalg.norm(feet - points[vertex], axis=1) <= reach[vertex]
    if not near.any():
        return None
    fan = _fans(arrays)
    corner = np.flatnonzero(np.isin(arrays.corners, vertex[near]))
    place = np.empty((fan.max() + 1, 3))
    place[fan] = points[arrays.corners]
    only = np.unique(fan[corner])
    border = core.module().joints.border_fits.border_of(place, fan, offsets, only)
    out = np.zeros((len(fan), 3), np.float32)
    row = border.slot[fan]
    # both sides of a joint have the same curve, and their fits see it differently
    aside = borders.dot(border.normal, border.along)[:, None] * border.along
    out[row >= 0] = borders.unit_vectors(border.normal - aside)[row[row >= 0]]
    flat = column(target.data.polygons, "use_smooth", bool)
    out[~np.repeat(flat, np.diff(offsets))] = 0
    return out


def _fans(arrays: core.ControlArrays) -> np.ndarray:
    """(c,): the fan of faces that each corner is in, around its vertex between sharp edges."""
    if arrays.sharp_edge is None or not arrays.sharp_edge.any():
        return arrays.corners.astype(np.int64)
    after = core.module().arrays.following(arrays.offsets)
    order = np.argsort(arrays.corner_edges, kind="stable")
    edge = arrays.corner_edges[order]
    same = np.flatnonzero((edge[1:] == edge[:-1]) & ~arrays.sharp_edge[edge[1:]])
    a, b = order[same], order[same + 1]
    alike = arrays.corners[a] == arrays.corners[b]  # faces that are flipped against each other
    pairs = np.concatenate(
        [
            np.stack([a, np.where(alike, b, after[b])], axis=1),
            np.stack([after[a], np.where(alike, after[b], b)], axis=1),
        ]
    )
    return core.module().arrays.connected_parts(len(arrays.corners), pairs).astype(np.int64)
