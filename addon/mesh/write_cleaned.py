# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a cleaned mesh by BMesh, only where it has changed, so that other data stay."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bmesh
import numpy as np

from ..blender import Object
from ..core import ControlArrays, module
from ..transfer.filling import Patch
from .edited import edited
from .write_filling import write_hole


@dataclass(frozen=True)
class Cleaned:
    """Like discrete_fairing.Cleaned, with flat faces."""

    positions: np.ndarray  # (N, 3) in the object's coordinates
    points: np.ndarray  # (N, 3) in the world's shape
    corners: np.ndarray
    offsets: np.ndarray
    vertex_origin: np.ndarray
    face_origin: np.ndarray
    corner_origin: np.ndarray

    @property
    def known(self) -> int:
        """Number of original vertices; all others follow."""
        return int((self.vertex_origin >= 0).sum())


def write_cleaned(target: Object, arrays: ControlArrays, made: Cleaned) -> None:
    """Changes the mesh of `target`, which has the `arrays`, to the cleaned mesh `made`, in any mode."""
    with edited(target) as bm:
        _change(bm, arrays, made)


def _change(bm: Any, arrays: ControlArrays, made: Cleaned) -> None:
    for elements in (bm.verts, bm.edges, bm.faces):
        elements.ensure_lookup_table()
    old_verts, old_faces = list(bm.verts), list(bm.faces)
    verts = _vertices(bm, arrays, made, old_verts)
    state = _states(arrays, made)
    for row in np.flatnonzero(state == _TURNED).tolist():
        old_faces[int(made.face_origin[row])].normal_flip()
    kept = np.zeros(len(old_faces), bool)
    kept[made.face_origin[(state == _SAME) | (state == _TURNED)]] = True
    other = np.flatnonzero(state == _OTHER).tolist()
    dropped = np.flatnonzero(~np.isin(np.arange(len(old_faces)), made.face_origin)).tolist()
    again = np.flatnonzero(~kept & np.isin(np.arange(len(old_faces)), made.face_origin)).tolist()
    edges, loose = _left_alone(arrays, [*dropped, *again])
    old_edges = [bm.edges[e] for e in edges]
    bmesh.ops.delete(bm, geom=[old_faces[f] for f in dropped], context="FACES_ONLY")
    for row in other:
        _make_again(bm, arrays, made, row, verts, old_verts, old_faces)
    bmesh.ops.delete(bm, geom=[old_faces[f] for f in again], context="FACES_ONLY")
    _fill(bm, made, verts)
    for edge in old_edges:
        if edge.is_valid and not edge.link_faces:
            bm.edges.remove(edge)
    for vertex in (old_verts[v] for v in loose):
        if vertex.is_valid and not vertex.link_edges:
            bm.verts.remove(vertex)
    bm.normal_update()


def _left_alone(arrays: ControlArrays, faces: list[int]) -> tuple[list[int], list[int]]:
    """Edges that may lose their last face with `faces`, and vertices their last edge."""
    gone = np.zeros(len(arrays.face_sizes), bool)
    gone[faces] = True
    beside = np.zeros(len(arrays.positions), bool)
    beside[arrays.corners[np.repeat(gone, arrays.face_sizes)]] = True
    edges = beside[arrays.edges].all(axis=1) & (arrays.edge_uses > 0)
    beside |= np.bincount(arrays.edges.ravel(), minlength=len(beside)) == 0
    return np.flatnonzero(edges).tolist(), np.flatnonzero(beside).tolist()


def _vertices(bm: Any, arrays: ControlArrays, made: Cleaned, old: Sequence[Any]) -> list[Any]:
    """The BMesh vertex of each vertex of `made`, or None; moved ones move in all shape keys."""
    keys = bm.verts.layers.shape.values()
    origin = made.vertex_origin[: made.known]
    first = np.zeros(len(origin), bool)
    first[np.unique(origin, return_index=True)[1]] = True
    way = made.positions[: len(origin)] - arrays.positions[origin]
    moved = (way != 0.0).any(axis=1)
    verts = [old[o] for o in origin.tolist()]
    for row in np.flatnonzero(~first).tolist():
        like = verts[row]
        verts[row] = bm.verts.new(like.co, like)
    for row in np.flatnonzero(moved).tolist():
        vertex, (x, y, z) = verts[row], way[row].tolist()
        for key in keys:
            place = vertex[key]
            vertex[key] = (place[0] + x, place[1] + y, place[2] + z)
        vertex.co = made.positions[row].tolist()
    return verts


_SAME, _TURNED, _OTHER, _NEW = range(4)


def _states(arrays: ControlArrays, made: Cleaned) -> np.ndarray:
    """(M,) the state of each face's original face."""
    origin = made.face_origin
    sizes = np.diff(made.offsets)
    old = origin >= 0
    f = np.where(old, origin, 0)
    fits = old & (sizes == arrays.face_sizes[f]) & (np.bincount(f[old], minlength=1)[f] == 1)
    starts = np.repeat(arrays.offsets[f], sizes)
    place = np.arange(len(made.corners)) - np.repeat(made.offsets[:-1], sizes)
    turned_place = np.where(place == 0, 0, np.repeat(sizes, sizes) - place)
    origin_v = made.vertex_origin[made.corners]
    first = np.zeros(len(made.vertex_origin), bool)
    known = made.vertex_origin[: made.known]
    first[np.unique(known, return_index=True)[1]] = True
    own = first[made.corners]
    corner = np.where(made.corner_origin >= 0, made.corner_origin, 0)
    own &= (made.corner_origin >= 0) & (origin_v == arrays.corners[corner])

    def all_of(flags: np.ndarray) -> np.ndarray:
        return np.logical_and.reduceat(flags, made.offsets[:-1])

    same = fits & all_of(own & (made.corner_origin == starts + place))
    turned = fits & all_of(own & (made.corner_origin == starts + turned_place))
    found = np.where(old, _OTHER, _NEW)
    found[turned] = _TURNED
    found[same] = _SAME
    return found


def _make_again(
    bm: Any,
    arrays: ControlArrays,
    made: Cleaned,
    row: int,
    verts: Sequence[Any],
    old_verts: Sequence[Any],
    old_faces: Sequence[Any],
) -> None:
    """Makes a face with other vertices; corners and edges take over its data, and it goes."""
    span = slice(int(made.offsets[row]), int(made.offsets[row + 1]))
    origins = made.corner_origin[span].tolist()
    face = old_faces[int(made.face_origin[row])]
    begin = int(arrays.offsets[made.face_origin[row]])
    end = int(arrays.offsets[made.face_origin[row] + 1])
    corners = [verts[v] for v in made.corners[span].tolist()]
    known = [bm.edges.get((a, b)) for a, b in _around(corners)]
    fresh = bm.faces.new(corners, face)
    for corner, origin in zip(fresh.loops, origins, strict=True):
        if begin <= origin < end:
            corner.copy_from(face.loops[origin - begin])
    before = [old_verts[v] for v in arrays.corners[origins].tolist()]
    for corner, there, (a, b) in zip(fresh.loops, known, _around(before), strict=True):
        edge = bm.edges.get((a, b)) if there is None and a != b else None
        if edge is not None:
            corner.edge.copy_from(edge)


def _around(items: Sequence[Any]) -> list[tuple[Any, Any]]:
    return list(zip(items, [*items[1:], items[0]], strict=True))


def _fill(bm: Any, made: Cleaned, verts: Sequence[Any]) -> None:
    for faces in _fillings(made):
        patch = Patch.of(faces, made.points[: made.known], made.points[made.known :])
        rim = [verts[v] for v in patch.rim.tolist()]
        write_hole(bm, patch, rim, made.positions[patch.fresh])


def _fillings(made: Cleaned) -> list[np.ndarray]:
    """(t, 3) ids of the new faces of each filling, connected by edges."""
    rows = np.flatnonzero(made.face_origin < 0)
    if not len(rows):
        return []
    sizes = np.diff(made.offsets)[rows]
    ends = np.cumsum(sizes)
    owner = np.repeat(np.arange(len(rows)), sizes)
    corners = made.corners[np.arange(len(owner)) + (made.offsets[rows] - ends + sizes)[owner]]
    after = corners[module().arrays.following(np.append(0, ends))]
    sides = np.sort(np.stack([corners, after], axis=1), axis=1)
    order = np.lexsort(sides.T)
    same = np.flatnonzero((sides[order[1:]] == sides[order[:-1]]).all(axis=1))
    pairs = np.stack([owner[order[same]], owner[order[same + 1]]], axis=1)
    part = module().patches.connected_parts(len(rows), pairs)
    groups, group = np.unique(np.stack([part, sizes], axis=1), axis=0, return_inverse=True)
    of_corners = group.reshape(-1)[owner]
    by_group = corners[np.argsort(of_corners, kind="stable")]
    found = np.split(by_group, np.cumsum(np.bincount(of_corners, minlength=len(groups)))[:-1])
    return [its.reshape(-1, size) for its, size in zip(found, groups[:, 1], strict=True)]
