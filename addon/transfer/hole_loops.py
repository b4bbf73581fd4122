# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the loops that are holes of a mesh, or of its remaining faces."""

from collections.abc import Iterable
from typing import TypeAlias

import numpy as np

from .. import core
from ..triangles import marked

Side: TypeAlias = frozenset[int]  # the two vertices of an edge


Faces: TypeAlias = tuple[np.ndarray, np.ndarray]  # corners and offsets


def holes_in(points: np.ndarray, faces: Faces) -> list[list[list[int]]]:
    """For each hole of a mesh with these `faces`: its rim, and the rims of its islands."""
    found = core.module().with_islands(points, faces) if len(faces[0]) else []
    return [[loop.tolist() for loop in hole] for hole in found]


def unclear_edges(
    arrays: core.ControlArrays, gone: np.ndarray, loops: list[list[int]]
) -> list[Side]:
    """Border edges where more than two faces meet or orientations differ: holes are ambiguous."""
    uses = _uses(arrays, gone)
    known = {side for loop in loops for side in sides_of(loop)}
    left = [e for e in np.flatnonzero(uses == 1).tolist() if _side(arrays, e) not in known]
    if not left:
        return []
    shared = np.add.reduceat(uses[arrays.corner_edges] > 1, arrays.offsets[:-1]) > 0
    beside = marked(arrays.corner_edges[(shared & ~gone)[arrays.face_of]], len(arrays.edges))
    return [_side(arrays, e) for e in left if beside[e]]


def _side(arrays: core.ControlArrays, edge: int) -> Side:
    return frozenset(arrays.edges[edge].tolist())


def _uses(arrays: core.ControlArrays, gone: np.ndarray) -> np.ndarray:
    """(e,) number of faces at each edge, without those that are `gone`."""
    left = arrays.corner_edges[~gone[arrays.face_of]]
    return np.bincount(left, minlength=len(arrays.edges))


def sides_of(loop: list[int]) -> Iterable[Side]:
    return (frozenset(pair) for pair in zip(loop, [*loop[1:], loop[0]], strict=True))


def where_faces_were(
    arrays: core.ControlArrays, gone: np.ndarray, loops: list[list[int]]
) -> list[list[list[int]]]:
    """The loops around each connected part of the deleted faces: its rim, the longest, then islands."""
    corners = np.flatnonzero(gone[arrays.face_of])
    corners = corners[np.argsort(arrays.corner_edges[corners], kind="stable")]
    edge, face = arrays.corner_edges[corners], arrays.face_of[corners]
    pairs = np.stack([face[:-1], face[1:]], axis=1)[edge[:-1] == edge[1:]]
    part = core.module().arrays.connected_parts(len(gone), pairs)[face]
    on_rim = (_uses(arrays, gone) > 0)[edge]
    rim = {_side(arrays, e): p for e, p in zip(edge[on_rim].tolist(), part[on_rim].tolist())}
    holes: dict[int, list[list[int]]] = {}
    for loop in loops:
        part = next((rim[side] for side in sides_of(loop) if side in rim), None)
        if part is not None:
            holes.setdefault(part, []).append(loop)
    return [sorted(hole, key=len, reverse=True) for _, hole in sorted(holes.items())]


def faces_left(arrays: core.ControlArrays, gone: np.ndarray) -> Faces:
    """The faces that are not `gone`, (m,) bool."""
    corners = arrays.corners[~gone[arrays.face_of]]
    return corners, np.concatenate([[0], np.cumsum(arrays.face_sizes[~gone])])
