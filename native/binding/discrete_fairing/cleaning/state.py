# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh between two steps of clean(), and the origin of its elements."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import backwards, connected_parts, face_vectors, fans, following, marked


@dataclass(frozen=True)
class State:
    """The mesh between two steps. Steps return a new State; arrays are shared and never written to."""

    points: np.ndarray  # (n, 3)
    corners: np.ndarray  # (c,) int64
    offsets: np.ndarray  # (m + 1,) int64
    vertex_origin: np.ndarray  # (n,) ids in the input; -1: a new one
    face_origin: np.ndarray  # (m,) ids in the whole mesh
    corner_origin: np.ndarray  # (c,)

    @classmethod
    def of(cls, points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> State:
        counts = len(points), len(offsets) - 1, len(corners)
        return cls(points, corners, offsets, *(np.arange(count) for count in counts))

    @cached_property
    def sides(self) -> Sides:
        return Sides(self)

    @property
    def face_of(self) -> np.ndarray:
        """(c,) the face of each corner."""
        return np.repeat(np.arange(len(self.face_origin)), np.diff(self.offsets))

    def without(self, gone: np.ndarray) -> State:
        """The state without the faces `gone`, (m,) bool. Vertices stay."""
        sizes = np.diff(self.offsets)
        kept = np.repeat(~gone, sizes)
        return self.replaced(
            corners=self.corners[kept],
            offsets=np.concatenate([[0], np.cumsum(sizes[~gone])]),
            face_origin=self.face_origin[~gone],
            corner_origin=self.corner_origin[kept],
        )

    def in_pieces(self, pieces: dict[int, list[list[tuple[int, int]]]]) -> State:
        """The state with faces (ids) replaced by pieces: lists of (vertex, corner that it comes from)."""
        whole = np.ones(len(self.face_origin), bool)
        whole[list(pieces)] = False
        rest = self.without(~whole)
        new = [corner for its in pieces.values() for piece in its for corner in piece]
        vertices, origins = np.array(new, np.int64).T
        face = [f for f, its in pieces.items() for _ in its]
        face = np.concatenate([np.flatnonzero(whole), np.array(face, np.int64)])
        new_sizes = [len(piece) for its in pieces.values() for piece in its]
        sizes = np.concatenate([np.diff(rest.offsets), new_sizes])
        order = np.argsort(face, kind="stable")
        ends = np.cumsum(sizes[order])
        shift = (np.cumsum(sizes) - sizes)[order] - (ends - sizes[order])
        at = np.arange(ends[-1]) + np.repeat(shift, sizes[order])
        return self.replaced(
            corners=np.concatenate([rest.corners, vertices])[at],
            offsets=np.concatenate([[0], ends]),
            face_origin=self.face_origin[face[order]],
            corner_origin=np.concatenate([rest.corner_origin, self.corner_origin[origins]])[at],
        )

    def turned(self, faces: np.ndarray) -> State:
        """The state with these faces (ids) reversed; their first corners stay first."""
        chosen = marked(faces, len(self.face_origin))[self.face_of]
        at = np.where(chosen, backwards(self.offsets), np.arange(len(self.corners)))
        return self.replaced(corners=self.corners[at], corner_origin=self.corner_origin[at])

    def replaced(self, **arrays: np.ndarray) -> State:
        return replace(self, **arrays)

    def with_split(self, corners: np.ndarray, vertices: np.ndarray) -> State:
        """The state with new `corners`, and with copies of `vertices` (ids) added at the end."""
        return self.replaced(
            points=np.concatenate([self.points, self.points[vertices]]),
            corners=corners,
            vertex_origin=np.concatenate([self.vertex_origin, self.vertex_origin[vertices]]),
        )

    def extended(self, points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> State:
        """The state of a filled mesh, whose first elements are those of this state."""

        def longer(origin: np.ndarray, count: int) -> np.ndarray:
            return np.concatenate([origin, np.full(count - len(origin), -1)])

        return State(
            points,
            corners,
            offsets,
            longer(self.vertex_origin, len(points)),
            longer(self.face_origin, len(offsets) - 1),
            longer(self.corner_origin, len(corners)),
        )

    def compact(self) -> tuple[State, np.ndarray]:
        """The state without vertices that have no face, new vertices last; and (n,) the new ids."""
        order = np.flatnonzero(marked(self.corners, len(self.points)))
        order = order[np.argsort(self.vertex_origin[order] < 0, kind="stable")]
        number = np.full(len(self.points), -1)
        number[order] = np.arange(len(order))
        compact = self.replaced(
            points=self.points[order],
            corners=number[self.corners],
            vertex_origin=self.vertex_origin[order],
        )
        return compact, number

    @cached_property
    def face_vectors(self) -> np.ndarray:
        """(m, 3) normals, whose lengths are twice the areas."""
        return face_vectors(self.points, self.corners, self.offsets)

    def triangles(self) -> np.ndarray:
        """(t, 3) vertex ids: each face as a fan from its first corner."""
        return self.corners[self.triangle_corners]

    @cached_property
    def triangle_corners(self) -> np.ndarray:
        """(t, 3) the corners of triangles()."""
        return fans(self.offsets[:-1], self.offsets[1:])


class Sides:
    """The faces at each edge. Side k runs from corner k to the next corner of its face."""

    def __init__(self, state: State) -> None:
        count = len(state.corners)
        self.next = following(state.offsets)
        begin, end = state.corners, state.corners[self.next]
        self.ends = np.stack([begin, end], axis=1)  # (c, 2) vertices
        self.forward = begin < end
        low, high = np.minimum(begin, end), np.maximum(begin, end)
        keys = low * np.int64(len(state.points)) + high
        self.order = np.argsort(keys, kind="stable")
        ranked = keys[self.order]
        first = np.ones(count, bool)
        first[1:] = ranked[1:] != ranked[:-1]
        self.starts = np.flatnonzero(first)  # position of each edge in `order`
        self.uses = np.diff(np.append(self.starts, count))  # (e,) faces at each edge
        self.edge = np.empty(count, np.int64)  # (c,)
        self.edge[self.order] = np.cumsum(first) - 1

    @cached_property
    def at_border(self) -> np.ndarray:
        """(c,) whether no other face is at a side."""
        return self.uses[self.edge] == 1

    @cached_property
    def pairs(self) -> np.ndarray:
        """(k, 2) the sides of edges with two faces."""
        at = self.starts[self.uses == 2]
        return np.stack([self.order[at], self.order[at + 1]], axis=1)

    @cached_property
    def crowded(self) -> np.ndarray:
        """Ids of edges with more than two faces."""
        return np.flatnonzero(self.uses > 2)

    def around(self, edge: int) -> np.ndarray:
        return self.order[self.starts[edge] : self.starts[edge] + self.uses[edge]]


def numbered_parts(state: State, pairs: np.ndarray) -> tuple[np.ndarray, int]:
    """(m,) the part of each face, and their number; `pairs` (k, 2) of sides connect faces."""
    faces = state.face_of[pairs]
    part = connected_parts(len(state.face_origin), faces)
    return part, int(part.max(initial=-1)) + 1


def all_pairs(state: State) -> np.ndarray:
    """(k, 2) pairs of successive sides at every edge, for any number of faces."""
    sides = state.sides
    same = sides.edge[sides.order[1:]] == sides.edge[sides.order[:-1]]
    at = np.flatnonzero(same)
    return np.stack([sides.order[at], sides.order[at + 1]], axis=1)


def diagonals(state: State, part: np.ndarray, count: int) -> np.ndarray:
    """(count,) diagonals of the bounding boxes of the parts."""
    of_corner = np.repeat(part, np.diff(state.offsets))
    order = np.argsort(of_corner, kind="stable")
    starts = np.searchsorted(of_corner[order], np.arange(count))
    points = state.points[state.corners[order]]
    size = np.maximum.reduceat(points, starts) - np.minimum.reduceat(points, starts)
    return np.linalg.norm(size, axis=1)
