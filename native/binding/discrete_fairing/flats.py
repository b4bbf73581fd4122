# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the faces of a control mesh that are meant to be flat, or straight: large ones between tight rims."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .arrays import connected_parts, face_arrays, marked, vertex_array
from .control_mesh import ControlMesh
from .converters import vertex_pairs

# largest distance of a flat's corners from its plane, relative to its size; files have about six digits
_IN_PLANE = 1e-3
_ROUND = 60.0  # degrees, the largest turn of a strip that is meant to be round
ANGLE = 1.0  # degrees, within which faces are joined unless a user says otherwise
# Least metric exponent beside flat faces. Rims of one segment leave a rounded box by 2 thousandths of its size with 0.9,
# and cut into it by 4 with 1; those of a cup have creases with 0.85.
SPACING = 0.95


def find_flats(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    angle: float = ANGLE,
    crease_edges: ArrayLike = (),
) -> np.ndarray:
    """(k,) ids of the faces that are meant to be flat, or straight in one direction, as fair() takes them in
    `flat_faces`: those between tight rims, such as the sides of a bevelled box or the wall of a can.
    `vertices` (n, 3), `faces` and `crease_edges`, where flats may end, are those of fair(); faces within `angle`
    (degrees) of each other are joined. Raises FairingError BAD_SHAPE.
    """
    mesh = ControlMesh.of(vertex_array(vertices), *face_arrays(faces))
    sharp = mesh.has_pair(vertex_pairs("crease_edges", crease_edges))
    return np.flatnonzero(kept_faces(mesh, angle, sharp))


def kept_faces(mesh: ControlMesh, angle: float, sharp: np.ndarray) -> np.ndarray:
    """(m,) bool: the faces of flats_of() and straights_of(). `sharp`: (e,) bool, edges that count as open borders."""
    if not len(mesh.face_sizes):
        return np.zeros(0, bool)
    parts = Parts.of(mesh, angle, sharp)
    return flats_of(parts) | straights_of(parts)


def flats_of(parts: Parts, tight: bool = False, other_half: np.ndarray | None = None) -> np.ndarray:
    """(m,) bool: the faces of flats. `tight`: only flats with quads all around that are no deeper, from the flat's
    border on, than the flat is wide; `other_half`: of `halves_of_quads`, which count as quads too.

    A part is a flat if at each of its borders, except open ones, the mesh turns away, the part is at least as
    wide as the part beside it, and it turns at most half as much per width. Where an arc joins a plane, the first
    edge turns half as much as the next, so flats at least as wide as the adjacent chords qualify; on
    spheres both turn alike.
    """
    mesh, owner, face = parts.mesh, parts.owner, parts.face
    width = _widths(mesh, parts.part, parts.edge, owner)[owner]
    joined = parts.twin >= 0
    here, there = np.flatnonzero(joined), parts.twin[joined]
    turns = parts.turns_beyond(width)[here]
    if tight:
        length, area = mesh.edge_lengths[parts.edge[there]], mesh.face_areas
        quad = mesh.face_sizes == 4
        if other_half is not None:
            quad |= other_half >= 0
            area += np.where(other_half >= 0, area[other_half], 0.0)
        turns &= quad[face[there]] & (area[face[there]] <= length * width[here])
    some = marked(owner[here], len(parts.plane))
    some[owner[here[~turns]]] = False
    return (some & parts.plane)[parts.part]


def straights_of(parts: Parts) -> np.ndarray:
    """(m,) bool: the faces of strips that turn about the direction of their rulings, as walls of cylinders and
    cones and rims of boxes do, and are meant to be straight in it.

    A part with four sides is straight between two opposite ones if the mesh turns away at both,
    the part is at least as deep as the part beside it, and it turns at most half as much per depth; one of them
    may be open. At its other two sides, unless these are open, the mesh turns by at most 60 degrees to another
    such part, or to a plane one with other than four sides, as a floor with round corners. A side is all of the border
    to one other part.
    """
    mesh = parts.mesh
    open_rows, count = parts.twin < 0, len(parts.plane)
    beside = np.where(open_rows, count + np.arange(len(parts.edge)), parts.owner[parts.twin])
    span = count + len(parts.edge)
    codes, side = np.unique(parts.owner * span + beside, return_inverse=True)
    owner, beside = np.divmod(codes, span)
    open_, turn = beside >= count, np.zeros(len(owner))
    np.maximum.at(turn, side, parts.turn)
    length = np.bincount(side, mesh.edge_lengths[parts.edge])
    depth = np.bincount(parts.part, mesh.face_areas)[owner] / length
    flush = open_rows | ~parts.turns_beyond(depth[side])
    rim = np.bincount(side, flush) == 0
    of_four = parts.plane & (np.bincount(owner, minlength=count) == 4)
    fours = np.flatnonzero(of_four[owner]).reshape(-1, 4)
    pairs = _opposite(np.repeat(side, 2), mesh.edges[parts.edge].ravel(), owner, fours)
    ends = (rim | open_)[pairs].all(axis=2) & rim[pairs].any(axis=2)
    while True:
        straight = marked(owner[pairs[ends.any(axis=1), 0, 0]], count)
        goes_on = open_ | (
            (straight | (parts.plane & ~of_four))[np.where(open_, owner, beside)] & (turn <= _ROUND)
        )
        kept = ends & goes_on[pairs[:, ::-1]].all(axis=2)
        if (kept == ends).all():
            return straight[parts.part]
        ends = kept


def _opposite(
    side: np.ndarray, vertex: np.ndarray, owner: np.ndarray, fours: np.ndarray
) -> np.ndarray:
    """(p, 2, 2) the sides of parts, (q, 4), as two pairs that share no vertex; parts without such pairs are
    left out. Each `side` (i,) has the `vertex` (i,); `owner`: the part of each side.
    """
    points = int(vertex.max(initial=0)) + 1
    side, vertex = np.divmod(np.unique(side * points + vertex), points)
    order = np.lexsort((vertex, owner[side]))
    side, vertex = side[order], vertex[order]
    meet = (vertex[1:] == vertex[:-1]) & (owner[side[1:]] == owner[side[:-1]])
    touching = np.sort(np.stack([side[:-1][meet], side[1:][meet]], axis=1), axis=1)
    codes = touching @ [len(owner), 1]
    apart = ~np.isin(fours[:, :1] * len(owner) + fours, codes)
    apart[:, 0] = False
    one = apart.sum(axis=1) == 1
    apart, fours = apart[one], fours[one]
    order = np.argsort(np.where(apart, 1, [0, 2, 2, 2]), axis=1, kind="stable")
    return np.take_along_axis(fours, order, axis=1).reshape(-1, 2, 2)


def halves_of_quads(mesh: ControlMesh, flush: np.ndarray) -> np.ndarray:
    """(m,) int: the triangle across the longest side of each triangle, if that is the longest of both and
    among the edges `flush` (e,) bool; elsewhere -1.
    """
    corner_length = mesh.edge_lengths[mesh.corner_edges]
    longest = np.maximum.reduceat(corner_length, mesh.offsets[:-1])
    is_longest = (corner_length == np.repeat(longest, mesh.face_sizes)) & np.repeat(
        mesh.face_sizes == 3, mesh.face_sizes
    )
    diagonal = flush & (np.bincount(mesh.corner_edges[is_longest], minlength=len(mesh.edges)) == 2)
    pair = mesh.faces_of_edges[diagonal]
    other = np.full(len(mesh.face_sizes), -1)
    other[pair] = pair[:, ::-1]
    return other


def plane_parts(mesh: ControlMesh, joined: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) the part of each face, (parts,) bool: planar; `joined` (e,) bool: edges inside."""
    count = len(mesh.face_sizes)
    pair = mesh.faces_of_edges[joined]
    part = connected_parts(count, pair)
    plane = _in_plane(mesh, part)[part]
    part = connected_parts(count, pair[plane[pair].all(axis=1)])
    return part, _in_plane(mesh, part)


def _in_plane(mesh: ControlMesh, part: np.ndarray) -> np.ndarray:
    """(parts,) bool: whether all corners lie in the plane of the part's first face with an area."""
    normals = mesh.face_normals
    has_area = np.flatnonzero((normals != 0.0).any(axis=1))
    count = int(part.max()) + 1
    normal = np.zeros((count, 3))
    # the last write is that of the first face
    normal[part[has_area[::-1]]] = normals[has_area[::-1]]
    owner = np.repeat(part, mesh.face_sizes)
    points = mesh.positions[mesh.corners]
    origin = np.zeros((count, 3))
    origin[owner[::-1]] = points[::-1]
    away = points - origin[owner]
    off, size = np.zeros(count), np.zeros(count)
    np.maximum.at(off, owner, np.abs((away * normal[owner]).sum(axis=1)))
    np.maximum.at(size, owner, np.linalg.norm(away, axis=1))
    return (np.bincount(owner) > 3) & (normal != 0.0).any(axis=1) & (off <= _IN_PLANE * size)


@dataclass(frozen=True)
class Parts:
    """The plane parts of a mesh, of faces that are joined within `angle` (degrees) and lie in one plane; and their b
    border edges, by ascending part.
    """

    mesh: ControlMesh
    angle: float
    part: np.ndarray  # (m,) of each face
    plane: np.ndarray  # (parts,) bool
    edge: np.ndarray  # (b,)
    face: np.ndarray  # (b,) the edge's face in the part
    owner: np.ndarray  # (b,) the part
    turn: np.ndarray  # (b,) degrees, 0 at open borders
    beyond: np.ndarray  # (b,) the largest turn at others of the part's borders
    twin: np.ndarray  # (b,) the row of the same edge in the other part; -1: open

    @classmethod
    def of(cls, mesh: ControlMesh, angle: float, sharp: np.ndarray) -> Parts:
        """Joined across edges that are not `sharp` (e,) bool; of one face at least."""
        folds, inside = mesh.fold_angles
        inside = inside & ~sharp
        part, plane = plane_parts(mesh, inside & (folds <= angle))
        pair = part[mesh.faces_of_edges]
        border = (pair[:, 0] != pair[:, 1]) | ~inside
        corners = np.flatnonzero(border[mesh.corner_edges])
        corners = corners[np.argsort(part[mesh.face_of[corners]], kind="stable")]
        edge, face = mesh.corner_edges[corners], mesh.face_of[corners]
        turn = np.where(inside[edge], folds[edge], 0.0)
        beyond = _turns_beyond(mesh, edge, part[face], turn)
        twin = np.where(sharp[edge], -1, _twins(edge))
        return cls(mesh, angle, part, plane, edge, face, part[face], turn, beyond, twin)

    def turns_beyond(self, size: np.ndarray) -> np.ndarray:
        """(b,) bool: the mesh turns there by more than the angle, the part is at least as large as the part
        beside it, by its `size` (b,), and it turns at most half as much for that. Not at open borders.
        """
        beside = size[self.twin]
        # turn / size <= 0.5 * beyond / size, without a division by zero
        half = 2.0 * self.turn * beside <= self.beyond[self.twin] * size
        return (self.turn > self.angle) & (size >= beside) & half


def _widths(mesh: ControlMesh, part: np.ndarray, edge: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """(parts,) twice the area over the length of the border, the edges `edge` (b,) of the parts
    `owner`: the width of a strip or ring, half the width of a square or disc.
    """
    border = np.bincount(owner, mesh.edge_lengths[edge], len(part))
    area = np.bincount(part, mesh.face_areas, len(part))
    return 2.0 * np.divide(area, border, out=np.zeros(len(part)), where=border > 0)


def _turns_beyond(
    mesh: ControlMesh, edge: np.ndarray, owner: np.ndarray, turn: np.ndarray
) -> np.ndarray:
    """(b,) for each border edge, the largest `turn` at others of its part; `owner` ascends."""
    ends = mesh.edges[edge]
    falling = np.lexsort((-turn, owner))
    begin = np.searchsorted(owner, owner)
    after = np.searchsorted(owner, owner, side="right")
    found, open_ = turn.copy(), np.arange(len(edge))
    # the largest that shares no vertex: few do, so few are tried
    for tried in range(len(edge)):
        open_ = open_[begin[open_] + tried < after[open_]]
        if not len(open_):
            break
        other = falling[begin[open_] + tried]
        apart = (ends[open_][:, :, None] != ends[other][:, None, :]).all(axis=(1, 2))
        found[open_[apart]] = np.maximum(turn[open_], turn[other])[apart]
        open_ = open_[~apart]
    return found


def _twins(edge: np.ndarray) -> np.ndarray:
    """(b,) the other row with the same edge; -1 if there is none, or more than one."""
    uses = np.bincount(edge)
    order = np.argsort(edge, kind="stable")
    two = order[uses[edge[order]] == 2].reshape(-1, 2)
    twin = np.full(len(edge), -1)
    twin[two] = two[:, ::-1]
    return twin
