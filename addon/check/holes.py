# SPDX-License-Identifier: GPL-3.0-or-later
"""The holes that a check lists: their widths and places."""

from typing import Any

from .. import core
from ..blender import Context, Object
from ..mesh.read import control_mesh, read_mesh
from ..mesh.world_shape import WorldShape
from ..transfer.hole_loops import holes_in, sides_of

MOST = 50  # the widest holes, which are kept; longer lists are of no use


def loops_of(arrays: core.ControlArrays) -> list[list[int]]:
    """The border loops of a mesh; none if the core refuses the mesh."""
    if not (arrays.edge_uses == 1).any():
        return []
    try:
        holes = holes_in(arrays.positions, (arrays.corners, arrays.offsets))
    except core.module().FairingError:
        return []
    return [loop for hole in holes for loop in hole]


def listed(arrays: core.ControlArrays, shape: WorldShape) -> list[dict[str, Any]]:
    """For each hole its `width`, the widest first, its number of `edges`, and one of them, `at`."""
    points, width_of = shape.of(arrays.positions), core.module().hole_width
    holes = [
        {"width": width_of(points[loop]), "edges": len(loop), "at": loop[:2]}
        for loop in loops_of(arrays)
    ]
    return sorted(holes, key=lambda hole: -hole["width"])[:MOST]


def edges_of(context: Context, target: Object, at: list[int]) -> list[list[int]]:
    """The edges of the hole with the edge `at`, as pairs of vertices; none if it no longer exists."""
    with control_mesh(context, target) as mesh:
        arrays = read_mesh(mesh)
    side = frozenset(at)
    found = next((loop for loop in loops_of(arrays) if side in sides_of(loop)), None)
    return [] if found is None else [list(pair) for pair in sides_of(found)]
