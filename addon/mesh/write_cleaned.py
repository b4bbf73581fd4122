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
from ..triangles import marked
from .edited import edited
from .write_filling import with_new, write_hole


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
    old_verts, old_edges, old_faces = list(bm.verts), list(bm.edges), list(bm.faces)
    state = _states(arrays, made)
    patches = _fillings(made)
    verts = _vertices(bm, arrays, made, patches, old_verts)
    models = _models(arrays, made, state == _OTHER, old_faces)
    for row in np.flatnonzero(state == _TURNED).tolist():
        old_faces[int(made.face_origin[row])].normal_flip()
    gone = np.ones(len(old_faces), bool)
    gone[made.face_origin[(state == _SAME) | (state == _TURNED)]] = False
    edges, loose = _left_alone(arrays, gone)
    going = [old_faces[f] for f in np.flatnonzero(gone).tolist()]
    bmesh.ops.delete(bm, geom=going, context="FACES_ONLY")
    for row in np.flatnonzero(state == _OTHER).tolist():
        _make_again(bm, arrays, made, row, verts, old_verts, models)
    for patch in patches:
        write_hole(bm, patch, [verts[v] for v in (*patch.rim.tolist(), *patch.fresh.tolist())])
    for edge in [old_edges[e] for e in edges]:
        if not edge.link_faces:
            bm.edges.remove(edge)
    spent = [corner.vert for corner in models.values()]
    spent += [old_verts[v] for v in loose if not old_verts[v].link_edges]
    bmesh.ops.delete(bm, geom=spent, context="VERTS")
    bm.normal_update()


def _left_alone(arrays: ControlArrays, gone: np.ndarray) -> tuple[list[int], list[int]]:
    """Edges that may lose their last face with the faces `gone`, (m,) bool, and vertices their last edge."""
    beside = marked(arrays.corners[np.repeat(gone, arrays.face_sizes)], len(arrays.positions))
    edges = beside[arrays.edges].all(axis=1) & (arrays.edge_uses > 0)
    beside |= np.bincount(arrays.edges.ravel(), minlength=len(beside)) == 0
    return np.flatnonzero(edges).tolist(), np.flatnonzero(beside).tolist()


def _vertices(
    bm: Any, arrays: ControlArrays, made: Cleaned, patches: list[Patch], old: Sequence[Any]
) -> list[Any]:
    """The BMesh vertex of each vertex of `made`. Copies, and new vertices of old faces only, take over the
    data of the old vertex there, and move in all shape keys as moved ones do.
    """
    keys = bm.verts.layers.shape.values()
    known, there = made.vertex_origin >= 0, made.corner_origin >= 0
    like = np.zeros(len(known), np.int64)
    like[made.corners[there]] = arrays.corners[made.corner_origin[there]]
    like[known] = made.vertex_origin[known]
    inside = np.zeros(len(known), bool)
    for patch in patches:
        inside[patch.fresh] = True
    verts = [old[v] for v in like.tolist()]
    for row in np.flatnonzero(~inside & ~_in_place(made)).tolist():
        verts[row] = bm.verts.new(verts[row].co, verts[row])
    way = made.positions - arrays.positions[like]
    for row in np.flatnonzero(~inside & (way != 0.0).any(axis=1)).tolist():
        vertex, (x, y, z) = verts[row], way[row].tolist()
        for key in keys:
            place = vertex[key]
            vertex[key] = (place[0] + x, place[1] + y, place[2] + z)
        vertex.co = made.positions[row].tolist()
    for patch in patches:
        rim = [verts[v] for v in patch.rim.tolist()]
        new = with_new(bm, patch, rim, made.positions[patch.fresh])[len(rim) :]
        for row, vertex in zip(patch.fresh.tolist(), new, strict=True):
            verts[row] = vertex
    return verts


def _in_place(made: Cleaned) -> np.ndarray:
    """(N,) whether a vertex is the old one itself, not a copy or new."""
    first = marked(np.unique(made.vertex_origin, return_index=True)[1], len(made.vertex_origin))
    return first & (made.vertex_origin >= 0)


_SAME, _TURNED, _OTHER, _NEW = range(4)


def _states(arrays: ControlArrays, made: Cleaned) -> np.ndarray:
    """(M,) the state of each face's original face."""
    origin, sizes = made.face_origin, np.diff(made.offsets)
    old = origin >= 0
    f = np.where(old, origin, 0)
    fits = old & (sizes == arrays.face_sizes[f]) & (np.bincount(f[old], minlength=1)[f] == 1)
    corner = np.maximum(made.corner_origin, 0)
    own = (made.corner_origin >= 0) & _in_place(made)[made.corners]
    own &= made.vertex_origin[made.corners] == arrays.corners[corner]
    own &= arrays.face_of[corner] == f.repeat(sizes)
    following = module().arrays.following
    after, next_old = corner[following(made.offsets)], following(arrays.offsets)

    def all_of(flags: np.ndarray) -> np.ndarray:
        return fits & np.logical_and.reduceat(own & flags, made.offsets[:-1])

    found = np.where(old, _OTHER, _NEW)
    found[all_of(next_old[after] == corner)] = _TURNED
    found[all_of(next_old[corner] == after)] = _SAME
    return found


def _models(
    arrays: ControlArrays, made: Cleaned, again: np.ndarray, old_faces: Sequence[Any]
) -> dict[int, Any]:
    """By id, the corners of the faces whose data the faces `again`, (M,) bool, take over; in copies on
    vertices of their own, since no face can be made where another still is.
    """
    corners = made.corner_origin[np.repeat(again, np.diff(made.offsets))]
    faces = np.union1d(made.face_origin[again], arrays.face_of[corners[corners >= 0]])
    found: dict[int, Any] = {}
    for face, begin in zip(faces.tolist(), arrays.offsets[faces].tolist(), strict=True):
        found.update(enumerate(old_faces[face].copy().loops, begin))
    return found


def _make_again(
    bm: Any,
    arrays: ControlArrays,
    made: Cleaned,
    row: int,
    verts: Sequence[Any],
    old_verts: Sequence[Any],
    models: dict[int, Any],
) -> None:
    """Makes a face with other vertices; corners and edges take over the data of the `models`."""
    span = slice(int(made.offsets[row]), int(made.offsets[row + 1]))
    origins = made.corner_origin[span].tolist()
    model = models[int(arrays.offsets[made.face_origin[row]])]
    corners = [verts[v] for v in made.corners[span].tolist()]
    known = [bm.edges.get(ends) for ends in _around(corners)]
    fresh = bm.faces.new(corners, model.face)
    for corner, origin in zip(fresh.loops, origins, strict=True):
        corner.copy_from(models.get(origin, model))
    before = [old_verts[arrays.corners[o]] if o >= 0 else None for o in origins]
    for corner, there, (a, b) in zip(fresh.loops, known, _around(before), strict=True):
        edge = bm.edges.get((a, b)) if there is None and a and b and a != b else None
        if edge is not None:
            corner.edge.copy_from(edge)


def _around(items: Sequence[Any]) -> list[tuple[Any, Any]]:
    return list(zip(items, [*items[1:], items[0]], strict=True))


def _fillings(made: Cleaned) -> list[Patch]:
    """The new faces, in patches that share neither edges nor new vertices."""
    rows = np.flatnonzero(made.face_origin < 0)
    sizes = np.diff(made.offsets)[rows]
    arrays = module().arrays
    corners = made.corners[arrays.ranges(made.offsets[rows], made.offsets[rows + 1])]
    after = corners[arrays.following(np.append(0, np.cumsum(sizes)))]
    owner = np.repeat(np.arange(len(rows)), sizes)
    fresh = made.vertex_origin[corners] < 0
    low, high = np.minimum(corners, after), np.maximum(corners, after)
    shared = np.concatenate([low * len(made.positions) + high, -1 - corners[fresh]])
    order = np.argsort(shared, kind="stable")
    same = np.flatnonzero(shared[order[1:]] == shared[order[:-1]])
    owners = np.concatenate([owner, owner[fresh]])[order]
    pairs = np.stack([owners[same], owners[same + 1]], axis=1)
    part = module().arrays.connected_parts(len(rows), pairs)
    by_part: dict[int, list[np.ndarray]] = {}
    for size in np.unique(sizes).tolist():
        faces, of = corners[sizes[owner] == size].reshape(-1, size), part[sizes == size]
        order = np.argsort(of, kind="stable")
        names, starts = np.unique(of[order], return_index=True)
        for name, its in zip(names.tolist(), np.split(faces[order], starts[1:]), strict=True):
            by_part.setdefault(name, []).append(its)
    return [_patch(made, faces) for faces in by_part.values()]


def _patch(made: Cleaned, faces: list[np.ndarray]) -> Patch:
    # where all vertices are new, the first is the rim
    known = max(made.known, 1 + min(int(its.min()) for its in faces))
    return Patch.of(faces, made.points[:known], made.points[known:])
