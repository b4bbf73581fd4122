# SPDX-License-Identifier: GPL-3.0-or-later
"""The neighbour that the border of a surface meets: which object it is, and its mesh.

Two surfaces that are each other's neighbour meet half way: each is given the other's surface as it would
be alone, from its source, so that neither depends on the other's mesh.

At joints each vertex has the normal of its surface, as a custom normal: Blender's own there is the mean of the faces on one
side, so reflections would break at a joint without a kink. Other borders keep Blender's: a Mirror or Weld modifier that
closes them would spoil custom normals.
"""

from collections.abc import Callable, Iterator
from typing import Any

import bpy
import numpy as np

from .. import core, memory
from ..blender import Context, Object, all_objects, column
from ..mesh.read import control_mesh, group_values, read_mesh, selected_faces
from ..mesh.world_shape import transformed, world_matrix, world_shape
from ..preferences import preferences
from ..settings import AnySettings, Settings, is_evaluated


def neighbour_of(target: Object | None) -> Object | None:
    """The mesh object that the border of `target` meets, or None."""
    if target is None or target.type != "MESH":
        return None
    found = target.discrete_fairing.neighbour
    return found if found is not None and found.type == "MESH" else None


def pair(context: Context) -> tuple[Object, Object] | None:
    """(surface, object that it is to meet) of two selected meshes: of two surfaces the active one is the
    first. None without a surface, or if not two are selected.
    """
    active = context.active_object
    others = [o for o in context.selected_objects if o != active]
    if active is None or len(others) != 1 or {active.type, others[0].type} != {"MESH"}:
        return None
    both = (active, others[0])
    return next(((a, b) for a, b in (both, both[::-1]) if memory.source_of(a)), None)


def why_not_both(target: Object | None, neighbour: Object) -> str:
    """Why these two cannot meet half way, a sentence; empty if they can."""
    for each in (target, neighbour):
        if each is not None and memory.source_of(each) is None:
            return f"Fair {each.name} first: only faired surfaces can both change"
        if each is not None and memory.scans_of(each):
            return f"{each.name} keeps to its scan: let the other surface meet it"
    return ""


def is_mutual(target: Object | None) -> bool:
    """Whether `target` and its neighbour meet each other, half way."""
    neighbour = neighbour_of(target)
    return (
        neighbour is not None
        and neighbour_of(neighbour) == target
        and not why_not_both(target, neighbour)
    )


def watched(target: Object) -> Object | None:
    """The object whose changes make `target` out of date: its neighbour, or the neighbour's source if
    each is the other's neighbour, since these would make each other out of date without end.
    """
    neighbour = neighbour_of(target)
    if neighbour is None or neighbour_of(neighbour) != target:
        return neighbour
    return memory.source_of(neighbour)


def with_scans(target: Object) -> list[Object]:
    """The other objects whose changes make the surface out of date."""
    other = watched(target)
    return memory.scans_of(target) + ([] if other is None else [other])


def arguments(
    context: Context,
    neighbour: Object,
    surface: Object,
    source: Object,
    settings: AnySettings,
    halfway: bool,
) -> dict[str, Any]:
    """The neighbour for `discrete_fairing.fair`, in the coordinates of the `surface`, scaled like its
    source in the world: as shown in the window, or with `halfway` as it would be alone (see
    core.with_partner).
    """
    stretch = np.linalg.inv(world_shape(source).way_back)
    way = stretch @ np.linalg.inv(np.array(world_matrix(surface), np.float64))
    found: Any = {"joint": settings.joint.lower()}
    if halfway:
        return found | {"partner": _alone(context, neighbour, way)}
    return found | {"neighbour": shown(context, neighbour, way)}


def _alone(
    context: Context, target: Object, way: np.ndarray
) -> Callable[[], tuple[np.ndarray, Any]]:
    """Computes a surface without a neighbour, moved by (4, 4) from the world; reads its source."""
    source, settings = memory.source_of(target), Settings.of(target.discrete_fairing)
    assert source is not None
    settings, shape = settings.for_source(source), world_shape(source)
    with control_mesh(context, source, is_evaluated(settings)) as mesh:
        arrays = shape.of_arrays(read_mesh(mesh))
        given = core.fair_arguments(
            arrays,
            settings,
            preferences(),
            selected_faces(mesh, source.name) if settings.use_selection else None,
            edge_length=arrays.mean_edge_length,
            **group_values(source, mesh, settings),
        )
    matrix = way @ np.array(world_matrix(target), np.float64) @ shape.way_back

    def computed() -> tuple[np.ndarray, Any]:
        result = core.faired(given)
        return transformed(result.vertices, matrix), result.faces

    return computed


def shown(
    context: Context,
    target: Object,
    way: np.ndarray | None = None,
    depsgraph: bpy.types.Depsgraph | None = None,
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Points and faces (corners, offsets) as shown in the window; `way`: (4, 4) from the world. `depsgraph`:
    as in control_mesh.
    """
    with control_mesh(context, target, evaluated=True, depsgraph=depsgraph) as mesh:
        arrays = read_mesh(mesh)
    matrix = np.array(world_matrix(target), np.float64)
    matrix = matrix if way is None else way @ matrix
    points = transformed(arrays.positions.astype(np.float64), matrix)
    return points, (arrays.corners.astype(np.int64), arrays.offsets.astype(np.int64))


def update_normals(
    context: Context, target: Object, depsgraph: bpy.types.Depsgraph | None = None
) -> None:
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
        found = _normals_at_joints(target, [shown(context, o, way, depsgraph) for o in met])
    if found is not None:
        mesh.normals_split_custom_set(found)
    elif mesh.has_custom_normals:
        _remove_normals(mesh)
    mesh.discrete_fairing.joint_normals = mesh.has_custom_normals


def _remove_normals(mesh: Any) -> None:
    stored = mesh.attributes.get("custom_normal")
    if stored is not None:
        mesh.attributes.remove(stored)
    else:  # no attribute before Blender 4.5; zero stands for Blender's own normals
        mesh.normals_split_custom_set(np.zeros((len(mesh.loops), 3), np.float32))


def update_normals_of_others(context: Context, target: Object) -> None:
    """The same for the other surfaces with joints, present or earlier ones, with `target` or another."""
    met = list(_met_by(target))
    for other in all_objects():
        if other.type != "MESH" or other == target or memory.source_of(other) is None:
            continue
        is_free = other.data.discrete_fairing.joint_normals and not any(_met_by(other))
        if other in met or is_free:
            update_normals(context, other)


def _met_by(target: Object) -> Iterator[Object]:
    """The objects that the border of `target` meets: its neighbour, and surfaces whose neighbour it is."""
    for other in all_objects():
        if other.type == "MESH" and other.users_scene:
            known = (neighbour_of(target), neighbour_of(other))
            if other == known[0] or target == known[1]:
                yield other


def _normals_at_joints(target: Object, others: list[Any]) -> np.ndarray | None:
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
