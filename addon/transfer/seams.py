# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges of a refined surface as pairs of vertices. No Blender.

Seams are those of half a mesh: borders in a coordinate plane, which a Mirror modifier joins to their images.
"""

from typing import Any

import numpy as np

from .. import core
from ..core import ControlArrays, module
from ..settings import Settings
from ..triangles import unit


def edge_table(faces: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """(e, 2) int32 edges of the core's faces, and (corners,) the edge that leaves each corner."""
    arrays = module().arrays
    edges, corner_edges = arrays.edges_of(*arrays.joined_faces(faces))
    return edges.astype(np.int32), corner_edges.astype(np.int32)


def mark_pairs(edges: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """(e,) bool: which of the `edges` (e, 2) are among the vertex `pairs` (k, 2), in either direction."""
    keys = module().arrays.pair_keys
    return np.isin(keys(edges), keys(pairs))


AXES = "XYZ"


def sharp_pairs(
    result: Any,
    arrays: ControlArrays,
    settings: Settings,
    levels: int,
    edges: tuple[np.ndarray, np.ndarray] | None = None,
) -> np.ndarray:
    """(k, 2) refined edges of `result` at which the surface is sharp: on creases, and on seams that fold."""
    creases = core.module().lattice.fine_edges(result.faces, result.crease_edges, levels)
    return np.concatenate([creases, seam_pairs(result, arrays, settings, edges)])


def seam_pairs(
    result: Any,
    arrays: ControlArrays,
    settings: Settings,
    edges: tuple[np.ndarray, np.ndarray] | None = None,
) -> np.ndarray:
    """(k, 2) refined edges of the core's `result` for the mesh `arrays`, both in the coordinates of the
    object, on seams that fold: if a connected seam turns anywhere by more than the crease angle of the
    `settings`, all of it, so that the fold does not end where it gets flat. None for a surface faired
    across its symmetry plane. `edges`: from `edge_table`.
    """
    axes = [axis for axis in half_axes(arrays) if AXES[axis] != settings.symmetry_plane]
    found = [np.empty((0, 2), np.int32)]
    if axes:
        table, corner_edges = edges or edge_table(result.faces)
        border = np.flatnonzero(np.bincount(corner_edges, minlength=len(table)) == 1)
        normals = _normals_beside(result, border, corner_edges)
        near = _reach(result.vertices)
    for axis in axes:
        flat = (np.abs(result.vertices[table[border], axis]) <= near).all(axis=1)
        pairs, along = table[border[flat]], normals[flat, axis]
        part = core.module().arrays.connected_parts(len(result.vertices), pairs)[pairs[:, 0]]
        # between the normals of a face and its image
        turns = np.arccos(np.clip(1.0 - 2.0 * along**2, -1.0, 1.0))
        found.append(pairs[np.isin(part, part[turns > settings.crease_angle])])
    return np.concatenate(found)


def _reach(points: np.ndarray) -> float:
    """The largest distance of points that count as in a plane."""
    return float(core.module().halves.SNAP * np.ptp(points, axis=0).max(initial=0.0))


def half_axes(arrays: ControlArrays) -> list[int]:
    """The axes whose plane has the whole mesh on one side, and border edges in it."""
    ends = arrays.positions[arrays.border_edges]
    used = arrays.positions[arrays.corners]
    if not len(ends):
        return []
    near = _reach(used)
    low, high = used.min(axis=0), used.max(axis=0)
    one_side = ((low >= -near) != (high <= near)) & (np.abs(ends) <= near).all(axis=1).any(axis=0)
    return [int(axis) for axis in np.flatnonzero(one_side)]


def _normals_beside(result: Any, border: np.ndarray, corner_edges: np.ndarray) -> np.ndarray:
    """(b, 3): the unit normal of the single face at each of the edges `border` (b,), ascending."""
    corner = np.flatnonzero(np.isin(corner_edges, border))
    corner = corner[np.argsort(corner_edges[corner])]
    triangles, quads = result.faces
    out = np.empty((len(border), 3))
    of_quad = corner >= triangles.size
    for faces, chosen, first in ((triangles, ~of_quad, 0), (quads, of_quad, triangles.size)):
        size = faces.shape[1]
        points = result.vertices[faces[(corner[chosen] - first) // size]]
        # the diagonals of a quad, two sides of a triangle
        out[chosen] = np.cross(points[:, 2] - points[:, 0], points[:, -1] - points[:, 1])
    return unit(out)
