# SPDX-License-Identifier: GPL-3.0-or-later
"""Which loops are holes of a mesh, or of what is left of it, and the faces around them."""

from collections.abc import Iterable
from typing import TypeAlias

import numpy as np

from .. import core
from .cut_out import CutOut, cut_out

RINGS, NOISY_RINGS = 2, 6  # of faces around a hole that decide what fills it
CELLS = 64  # along the longest side of a mesh, by which it is known what is near a hole

Side: TypeAlias = frozenset[int]  # the two vertices of an edge


def loops_without(
    arrays: core.ControlArrays, points: np.ndarray, gone: np.ndarray
) -> list[list[int]]:
    """Around the holes that are there without the faces `gone`: only those at a border are looked at."""
    return [loop for hole in holes_without(arrays, points, gone) for loop in hole]


def holes_without(
    arrays: core.ControlArrays, points: np.ndarray, gone: np.ndarray
) -> list[list[list[int]]]:
    """The same by holes: of each its rim, and the rims of islands in it."""
    kept = np.repeat(~gone, arrays.face_sizes)
    border = arrays.edges[_uses(arrays, gone) == 1]
    at_border = np.zeros(len(points), bool)
    at_border[border] = True
    face_of = np.repeat(np.arange(len(gone)), arrays.face_sizes)
    near = np.zeros(len(gone), bool)
    near[face_of[at_border[arrays.corners] & kept]] = True
    if not near.any():
        return []
    part = cut_out(arrays, near)
    mesh = points[part.vertices], flat_faces(part.arrays)
    sides = set(map(frozenset, border.tolist()))
    ours = [  # the others are only there where the part was cut out
        loop
        for loop in core.module().find_holes(*mesh)
        if sides.issuperset(sides_of(part.vertices[loop].tolist()))
    ]
    found = core.module().with_islands(*mesh, ours) if ours else []
    return [[part.vertices[loop].tolist() for loop in hole] for hole in found]


def unclear_edges(
    arrays: core.ControlArrays, gone: np.ndarray, loops: list[list[int]]
) -> list[Side]:
    """Border edges that are around no hole, of faces that have neighbours: where more than two faces
    meet at an edge, or neighbours look different ways, nobody could say what a hole is.
    """
    uses = _uses(arrays, gone)
    known = {side for loop in loops for side in sides_of(loop)}
    left = [e for e in np.flatnonzero(uses == 1).tolist() if _side(arrays, e) not in known]
    if not left:
        return []
    shared = np.add.reduceat(uses[arrays.corner_edges] > 1, arrays.offsets[:-1]) > 0
    beside = np.zeros(len(arrays.edges), bool)
    beside[arrays.corner_edges[np.repeat(shared & ~gone, arrays.face_sizes)]] = True
    return [_side(arrays, e) for e in left if beside[e]]


def _side(arrays: core.ControlArrays, edge: int) -> Side:
    return frozenset(arrays.edges[edge].tolist())


def _uses(arrays: core.ControlArrays, gone: np.ndarray) -> np.ndarray:
    """(e,) faces at each edge without those that are `gone`."""
    corners = arrays.corner_edges
    if gone.any():
        corners = corners[np.repeat(~gone, arrays.face_sizes)]
    return np.bincount(corners, minlength=len(arrays.edges))


def sides_of(loop: list[int]) -> Iterable[Side]:
    return (frozenset(pair) for pair in zip(loop, [*loop[1:], loop[0]], strict=True))


def where_faces_were(
    arrays: core.ControlArrays, gone: np.ndarray, loops: list[list[int]]
) -> list[list[list[int]]]:
    """The loops around each connected part of the erased faces: its rim, the longest, then islands."""
    faces = np.flatnonzero(gone).tolist()
    edges_of = {f: arrays.corner_edges[arrays.offsets[f] : arrays.offsets[f + 1]] for f in faces}
    faces_at: dict[int, list[int]] = {}
    for face, edges in edges_of.items():
        for edge in edges.tolist():
            faces_at.setdefault(edge, []).append(face)
    part_of: dict[int, int] = {}
    for first in faces:
        stack = [] if first in part_of else [first]
        part_of.setdefault(first, len(part_of))
        while stack:
            beside = {f for e in edges_of[stack.pop()].tolist() for f in faces_at[e]}
            fresh = [f for f in beside if f not in part_of]
            part_of.update(dict.fromkeys(fresh, part_of[first]))
            stack += fresh
    uses = arrays.edge_uses
    rim = {
        frozenset(arrays.edges[edge].tolist()): part_of[at[0]]
        for edge, at in faces_at.items()
        if len(at) < uses[edge]
    }
    holes: dict[int, list[list[int]]] = {}
    for loop in loops:
        part = next((rim[side] for side in sides_of(loop) if side in rim), None)
        if part is not None:
            holes.setdefault(part, []).append(loop)
    return [sorted(hole, key=len, reverse=True) for _, hole in sorted(holes.items())]


def around(
    arrays: core.ControlArrays,
    points: np.ndarray,
    gone: np.ndarray,
    holes: list[list[list[int]]],
    noisy: bool = False,
) -> CutOut:
    """The faces that are near these `holes`, without those that are `gone` (m,) bool, in a mesh at
    `points` (n, 3): as many rings as the core reads, more where the rim is `noisy`, and those that a
    filling may pass through.
    """
    left = np.repeat(~gone, arrays.face_sizes)
    face_of = np.repeat(np.arange(len(gone)), arrays.face_sizes)
    marked = np.zeros(len(arrays.positions), bool)
    marked[[v for hole in holes for loop in hole for v in loop]] = True
    for _ in range(NOISY_RINGS if noisy else RINGS):
        near = np.zeros(len(gone), bool)
        near[face_of[marked[arrays.corners] & left]] = True
        marked[arrays.corners[near[face_of]]] = True
    near[face_of[_within_reach(points, holes)[arrays.corners] & left]] = True
    return cut_out(arrays, near)


def _within_reach(points: np.ndarray, holes: list[list[list[int]]]) -> np.ndarray:
    """(n,) which points fillings may come to: in the boxes of their rims, by half a diagonal wider, as
    what fills half a sphere or a little more; in whole cells of a coarse grid.
    """
    low = points.min(axis=0)
    size = max(float((points.max(axis=0) - low).max()) / CELLS, 1e-300)
    marked = np.zeros((CELLS + 1,) * 3, bool)
    for hole in holes:
        rim = points[hole[0]]
        reach = np.linalg.norm(np.ptp(rim, axis=0)) / 2.0
        first = ((rim.min(axis=0) - reach - low) / size).clip(0, CELLS).astype(int)
        last = ((rim.max(axis=0) + reach - low) / size).clip(0, CELLS).astype(int)
        marked[tuple(slice(a, b + 1) for a, b in zip(first, last, strict=True))] = True
    x, y, z = ((points - low) / size).astype(np.int32).T
    return marked[x, y, z]


def flat_faces(
    arrays: core.ControlArrays, kept: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Corners and offsets of the faces `kept` (m,) bool, or of all, as the core takes them."""
    sizes = arrays.face_sizes if kept is None else arrays.face_sizes[kept]
    corners = arrays.corners if kept is None else arrays.corners[np.repeat(kept, arrays.face_sizes)]
    return corners.astype(np.int64), np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
