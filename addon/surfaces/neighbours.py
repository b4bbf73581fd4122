# SPDX-License-Identifier: GPL-3.0-or-later
"""The neighbour that the border of a surface meets: which object it is, and its mesh.

Two surfaces that are each other's neighbour meet half way: each is given the other's surface as it would
be alone, from its source, so that neither depends on the other's mesh.
"""

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from .. import core, memory
from ..blender import Context, Object
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
