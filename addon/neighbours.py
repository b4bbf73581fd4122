# SPDX-License-Identifier: GPL-3.0-or-later
"""The neighbour that the border of a surface meets: which object it is, and its mesh."""

from typing import Any

import numpy as np

from . import memory
from .blender import Context, Object
from .mesh.read import control_mesh, read_mesh
from .mesh.world_shape import transformed, world_matrix, world_shape
from .settings import AnySettings


def neighbour_of(target: Object | None) -> Object | None:
    """The mesh object that the border of `target` meets, or None."""
    if target is None or target.type != "MESH":
        return None
    found = target.discrete_fairing.neighbour
    return found if found is not None and found.type == "MESH" else None


def watched(target: Object) -> Object | None:
    """The neighbour whose changes make `target` out of date. None for two surfaces that meet each
    other: each would make the other out of date without end.
    """
    neighbour = neighbour_of(target)
    return None if neighbour is None or neighbour_of(neighbour) == target else neighbour


def with_scans(target: Object) -> list[Object]:
    """The other objects whose changes make the surface out of date."""
    neighbour = watched(target)
    return memory.scans_of(target) + ([] if neighbour is None else [neighbour])


def arguments(
    context: Context, neighbour: Object, surface: Object, source: Object, settings: AnySettings
) -> dict[str, Any]:
    """The neighbour for `discrete_fairing.fair`: as shown in the window, in the coordinates of the
    `surface`, scaled like its source in the world.
    """
    stretch = np.linalg.inv(world_shape(source).way_back)
    way = stretch @ np.linalg.inv(np.array(world_matrix(surface), np.float64))
    return {"neighbour": _shown(context, neighbour, way), "joint": settings.joint.lower()}


def shown_in_world(
    context: Context, target: Object
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Points and faces (corners, offsets) of `target` as shown in the window, in the world."""
    return _shown(context, target, np.eye(4))


def _shown(
    context: Context, target: Object, way: np.ndarray
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """The same, transformed by a (4, 4) matrix from the world."""
    with control_mesh(context, target, evaluated=True) as mesh:
        arrays = read_mesh(mesh)
    matrix = way @ np.array(world_matrix(target), np.float64)
    points = transformed(arrays.positions.astype(np.float64), matrix)
    return points, (arrays.corners.astype(np.int64), arrays.offsets.astype(np.int64))
