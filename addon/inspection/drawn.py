# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as arrays for a graphics card. No Blender."""

from dataclasses import dataclass

import numpy as np

_SAME = 1e-4  # relative to a unit normal: corners with a smaller difference share a point


@dataclass(frozen=True)
class Drawn:
    """k points, t triangles."""

    points: np.ndarray  # (k, 3) float32
    normals: np.ndarray  # (k, 3) float32, unit
    triangles: np.ndarray  # (t, 3) int32


def drawn(
    positions: np.ndarray, corners: np.ndarray, corner_normals: np.ndarray, triangles: np.ndarray
) -> Drawn:
    """Arrays from `positions` (n, 3), `corners` (c,) the vertex of each corner, `corner_normals` (c,
    3), and `triangles` (t, 3) of corners.

    Corners at a vertex share a point if they have the same normal; across a sharp edge each has its
    own.
    """
    normals = np.zeros((len(positions), 3), np.float32)
    normals[corners[::-1]] = corner_normals[::-1]  # the last assignment wins
    own = np.flatnonzero((np.abs(corner_normals - normals[corners]) > _SAME).any(axis=1))
    point_of = corners.astype(np.int32)
    point_of[own] = len(positions) + np.arange(len(own), dtype=np.int32)
    return Drawn(
        np.concatenate([positions, positions[corners[own]]]).astype(np.float32, copy=False),
        np.concatenate([normals, corner_normals[own]]).astype(np.float32, copy=False),
        point_of[triangles],
    )
