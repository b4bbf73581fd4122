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
    """The neighbour whose changes leave `target` out of date: of two surfaces that meet each other, each
    would do so to the other without end.
    """
    neighbour = neighbour_of(target)
    return None if neighbour is None or neighbour_of(neighbour) == target else neighbour


def with_scans(target: Object) -> list[Object]:
    """The other objects whose changes leave the surface out of date."""
    neighbour = watched(target)
    return memory.scans_of(target) + ([] if neighbour is None else [neighbour])


def arguments(
    context: Context, neighbour: Object, surface: Object, source: Object, settings: AnySettings
) -> dict[str, Any]:
    """Of `discrete_fairing.fair`: the neighbour as the window shows it, where the own coordinates of the
    `surface` are, in the size that its source has in the world.
    """
    stretch = np.linalg.inv(world_shape(source).way_back)
    way = stretch @ np.linalg.inv(np.array(world_matrix(surface), np.float64))
    return {"neighbour": _shown(context, neighbour, way), "joint": settings.joint.lower()}


def shown_in_world(
    context: Context, target: Object
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Points and faces (corners, offsets) of `target` as the window shows it, in the world."""
    return _shown(context, target, np.eye(4))


def _shown(
    context: Context, target: Object, way: np.ndarray
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """The same, moved by a (4, 4) matrix from the world."""
    with control_mesh(context, target, evaluated=True) as mesh:
        arrays = read_mesh(mesh)
    matrix = way @ np.array(world_matrix(target), np.float64)
    points = transformed(arrays.positions.astype(np.float64), matrix)
    return points, (arrays.corners.astype(np.int64), arrays.offsets.astype(np.int64))
