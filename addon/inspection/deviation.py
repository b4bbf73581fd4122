# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a surface is from its control vertices, or from another object, at each of its vertices."""

from typing import Any

import numpy as np
from mathutils import bvhtree, kdtree

from ..blender import Context, Object
from ..core import ControlArrays
from ..mesh.read import control_mesh, read_mesh
from ..mesh.world_shape import world_matrix, world_shape


def from_vertices(target: Object, positions: np.ndarray, control: np.ndarray) -> np.ndarray:
    """(n,) at each of the surface's `positions` (n, 3) how far the surface misses the nearest of
    the `control` vertices (k, 3); positive where it passes on its outer side. Both in the
    coordinates of `target`, whose mesh the surface is; lengths in scene units.
    """
    shape = world_shape(target)
    control, surface = shape.of(control), shape.of(positions)
    missed = -signed_distances(_tree(surface, read_mesh(target.data)), control)
    nearest: Any = kdtree.KDTree(len(control))
    for index, point in enumerate(control):
        nearest.insert(point, index)
    nearest.balance()
    return missed[[nearest.find(point)[1] for point in surface]]


def from_object(
    context: Context, target: Object, positions: np.ndarray, other: Object
) -> np.ndarray:
    """(n,) at each of the surface's `positions` (n, 3) the distance to the mesh of `other` as it is
    seen, in scene units; positive on the outer side of its faces.
    """
    with control_mesh(context, other, evaluated=True) as mesh:
        arrays = read_mesh(mesh)
    there = _in_world(other, arrays.positions)
    return signed_distances(_tree(there, arrays), _in_world(target, positions))


def signed_distances(tree: Any, points: np.ndarray) -> np.ndarray:
    """(n,) of `points` (n, 3) to the surface in the BVH `tree`, positive on its outer side; 0 where
    there is none.
    """
    out = np.zeros(len(points))
    for row, point in enumerate(points.tolist()):
        place, normal, _, distance = tree.find_nearest(point)
        if place is not None:
            outside = sum((p - q) * n for p, q, n in zip(point, place, normal))
            out[row] = distance if outside >= 0.0 else -distance
    return out


def _tree(positions: np.ndarray, arrays: ControlArrays) -> Any:
    """Of the faces of `arrays` at other `positions`."""
    faces = np.split(arrays.corners, arrays.offsets[1:-1])
    make: Any = bvhtree.BVHTree.FromPolygons
    return make(positions.tolist(), [face.tolist() for face in faces])


def _in_world(target: Object, positions: np.ndarray) -> np.ndarray:
    matrix: Any = np.array(world_matrix(target))
    return positions @ matrix[:3, :3].T + matrix[:3, 3]
