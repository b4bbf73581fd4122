# SPDX-License-Identifier: GPL-3.0-or-later
"""The distance of a surface from its control vertices, or from another object, at each of its vertices."""

from typing import Any

import numpy as np
from mathutils import Vector, bvhtree, kdtree

from ..blender import Object, column
from ..mesh.scans import Scan, of_mesh
from ..mesh.world_shape import transformed, world_matrix, world_shape

_ROUNDING = 1e-4  # relative to a distance, since Blender's trees are single precision


def from_vertices(target: Object, positions: np.ndarray, control: np.ndarray) -> np.ndarray:
    """(n,) at each of the surface's `positions` (n, 3) the distance of the surface from the nearest of
    the `control` vertices (k, 3); positive if the surface is on their outer side. Both in the
    coordinates of `target`, whose mesh the surface is; lengths in scene units.
    """
    shape = world_shape(target)
    control, surface = shape.of(control), shape.of(positions)
    nearest, _ = _nearest(control, surface)
    used = np.unique(nearest)
    tree = _tree(surface, of_mesh(target.data).triangles)
    missed = np.zeros(len(control))
    missed[used] = -signed_distances(tree, control[used])
    return missed[nearest]


def from_scan(target: Object, positions: np.ndarray, scan: Scan) -> np.ndarray:
    """(n,) at each of the surface's `positions` (n, 3) the distance from a scan, or any mesh, in the world, in
    scene units; positive outside. For points without triangles, the side is that of the surface's normals.
    """
    matrix = np.array(world_matrix(target), dtype=np.float64)
    surface = transformed(positions, matrix)
    if not len(scan.points):
        return np.zeros(len(surface))
    if len(scan.triangles):
        return signed_distances(_tree(scan.points, scan.triangles), surface)
    normals = column(target.data.vertex_normals, "vector", width=3)
    linear = matrix[:3, :3]
    turned = normals @ np.linalg.inv(linear) * np.sign(np.linalg.det(linear))
    nearest, away = _nearest(scan.points, surface)
    outside = ((surface - scan.points[nearest]) * turned).sum(axis=1) >= 0.0
    return np.where(outside, away, -away)


def signed_distances(tree: Any, points: np.ndarray) -> np.ndarray:
    """(n,) distances of `points` (n, 3) from the BVH `tree`, above 0 outside; 0 if empty."""
    find, out = tree.find_nearest, []
    place: Any = find(points[0].tolist())[0] if len(points) else None
    if place is None:
        return np.zeros(len(points))
    for point in map(Vector, points.tolist()):
        # points mostly follow one another: the last foot is near and shortens the search
        within = (1.0 + _ROUNDING) * (point - place).length + _ROUNDING * point.length
        place, normal, _, distance = find(point, within)
        if place is None:
            place, normal, _, distance = find(point)
        out.append(distance if normal.dot(point - place) >= 0.0 else -distance)
    return np.array(out)


def _nearest(control: np.ndarray, surface: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n,) the nearest of the `control` vertices for each point of the `surface`, and its distance."""
    tree: Any = kdtree.KDTree(len(control))
    for index, point in enumerate(control.tolist()):
        tree.insert(point, index)
    tree.balance()
    find = tree.find
    nearest = np.fromiter((find(p)[1] for p in surface.tolist()), np.intp, len(surface))
    return nearest, np.linalg.norm(surface - control[nearest], axis=1)


def _tree(points: np.ndarray, triangles: np.ndarray) -> Any:
    make: Any = bvhtree.BVHTree.FromPolygons
    return make(points.tolist(), triangles.tolist(), all_triangles=True)
