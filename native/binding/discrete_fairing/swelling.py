# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds control meshes whose surface through the vertices passes through itself where walls are close, as between
fingers: the mesh with its faces raised as high as circular arcs between their folds crosses itself.
"""

from __future__ import annotations

import numpy as np

from . import _native
from .arrays import connected_parts, following, marked
from .control_mesh import ControlMesh


def swells_into_itself(mesh: ControlMesh, turns: np.ndarray, rises: np.ndarray) -> bool:
    """Whether faces that do not cross, do so if raised. `turns` (e,): by how much the surface turns at each edge, in
    radians, negative where it turns inwards; `rises` (m, 3): unit vectors outwards. Triangles and faces without a
    turn stay as they are and count for nothing; so do crossings of separate parts.
    """
    height = _heights(mesh, turns)
    raised = (mesh.face_sizes > 3) & (height > 0.0)
    if not raised.any():
        return False
    points = _apart(mesh)
    crossing = _crossing(mesh, points, raised, height[:, None] * rises)
    if not crossing.any():
        return False
    return bool((crossing & ~_crossing(mesh, points, raised, 0.0 * rises)).any())


def _heights(mesh: ControlMesh, turns: np.ndarray) -> np.ndarray:
    """(m,) heights of the faces' centres above their edges: means of arcs from each edge that turns, for which
    short distances and large turns weigh most.
    """
    start = mesh.positions[mesh.corners]
    side = start[following(mesh.offsets)] - start
    length = np.linalg.norm(side, axis=1)
    area = np.linalg.norm(np.cross(mesh.face_centres[mesh.face_of] - start, side), axis=1)
    slope = np.tan(0.25 * turns[mesh.corner_edges])
    slope[area == 0.0] = 0.0
    # with weights |slope| · length / distance from the centre
    weight = np.abs(slope) * length**2 / np.where(area > 0.0, area, 1.0)
    rise = np.bincount(mesh.face_of, np.abs(slope) * slope * length)
    whole = np.bincount(mesh.face_of, weight)
    return np.asarray(rise / np.where(whole > 0.0, whole, 1.0))


def _apart(mesh: ControlMesh) -> np.ndarray:
    """(n, 3) the vertices, with connected parts side by side."""
    part = connected_parts(len(mesh.positions), mesh.edges)
    width = 2.0 * np.ptp(mesh.positions[:, 0]) + np.ptp(mesh.positions)
    return mesh.positions + np.outer(np.unique(part, return_inverse=True)[1] * width, [1, 0, 0])


def _crossing(
    mesh: ControlMesh, points: np.ndarray, raised: np.ndarray, by: np.ndarray
) -> np.ndarray:
    """(m,) bool: faces, as pyramids whose tips are their centres moved `by` (m, 3), that cross others."""
    owner = mesh.face_of
    used = raised[owner]
    sums = np.add.reduceat(points[mesh.corners], mesh.offsets[:-1], axis=0)
    tips = sums / mesh.face_sizes[:, None] + by
    sides = [mesh.corners, mesh.corners[following(mesh.offsets)], len(points) + owner]
    triangles = np.column_stack(sides)[used].astype(np.int32)
    monitor = _native.Monitor()
    found = _native._crossings(np.concatenate([points, tips]), triangles, 0, monitor, None)
    return marked(owner[used][found], len(raised))
