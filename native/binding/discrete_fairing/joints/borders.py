# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh at its border: the curve through its vertices, and what `border_fits` finds there; and the surface half way
between two that share a border.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import face_arrays, following, joined_faces, pair_keys, vertex_array
from ..errors import fairing_error

# (vertices, faces)
Mesh = tuple[ArrayLike, Any]

# The cosine of the turn at a corner of a border, and iterations for the nearest point on its curve, which end at a
# step of rounding's size.
STRAIGHT = float(np.cos(np.radians(30)))
NEWTON, EXACT = 6, 1e-14


@dataclass(frozen=True)
class BorderCurve:
    """The curve through the vertices of border edges.

    edge: (b, 2) vertices, with the face on the left; face: (b,) that face. vertex: (k,) the vertices;
    point: (k, 3).
    """

    edge: np.ndarray
    face: np.ndarray
    vertex: np.ndarray
    point: np.ndarray
    slot: np.ndarray  # (n,): the row of each vertex of the mesh; -1 off the border

    @cached_property
    def links(self) -> np.ndarray:
        """(b, 2): the edges before and after each, -1 at ends and at corners."""
        out = np.full((len(self.edge), 2), -1)
        starts = np.full(len(self.slot), -1)
        starts[self.edge[:, 0]] = np.arange(len(self.edge))
        after = starts[self.edge[:, 1]]
        way = unit_vectors(self.point[self.ends[1]] - self.point[self.ends[0]])
        on = np.flatnonzero((after >= 0) & (dot(way, way[after]) > STRAIGHT))
        out[on, 1], out[after[on], 0] = after[on], on
        return out

    @cached_property
    def along(self) -> np.ndarray:
        """(k, 3): unit tangents of the curve; at a corner the mean of both sides."""
        rows, weights = self.cubics
        out = np.zeros_like(self.point)
        for end, slope in ((1, [0, 1, 2, 3]), (0, [0, 1, 0, 0])):
            way = np.einsum("c,bcs,bsj->bj", slope, weights, self.point[rows])
            np.add.at(out, self.ends[end], unit_vectors(way))
        return unit_vectors(out)

    @cached_property
    def ends(self) -> np.ndarray:
        """(2, b): the rows of each edge's vertices."""
        return self.slot[self.edge.T]

    @cached_property
    def cubics(self) -> tuple[np.ndarray, np.ndarray]:
        """(b, 4) rows of the vertices before, at and after each edge, and (b, 4, 4): the matrix from
        them to the coefficients of the edge's cubic, whose slopes are those of parabolas through three
        vertices.
        """
        before, after = self.links.T
        rows = np.stack(
            [
                np.where(before < 0, self.ends[0], self.ends[0, before]),
                *self.ends,
                np.where(after < 0, self.ends[1], self.ends[1, after]),
            ],
            axis=1,
        )
        unit = np.eye(4)
        length = np.linalg.norm(self.point[self.ends[1]] - self.point[self.ends[0]], axis=1)
        ratio = length[self.links] / length[:, None]
        step = unit[2] - unit[1]
        slopes = np.empty((2, len(rows), 4))
        for side, beside in enumerate((unit[1] - unit[0], unit[3] - unit[2])):
            part = ratio[:, side, None]
            slopes[side] = (beside / part + step * part) / (1 + part)
        off = self.links.T[..., None] < 0
        low, high = np.where(off, np.where(off[::-1], step, 2 * step - slopes[::-1]), slopes)
        first = np.broadcast_to(unit[1], low.shape)
        return rows, np.stack(
            [first, low, 3 * step - 2 * low - high, low + high - 2 * step], axis=1
        )

    def shares(self, edge: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(p, 4) rows of vertices, and their weights in interpolated values at parameters of edges."""
        rows, cubics = self.cubics
        powers = np.clip(share, 0, 1)[:, None] ** np.arange(4)
        return rows[edge], np.einsum("pc,pcs->ps", powers, cubics[edge])

    def between(self, values: np.ndarray, edge: np.ndarray, share: np.ndarray) -> np.ndarray:
        """Values at vertices, interpolated at parameters of edges."""
        rows, weights = self.shares(edge, share)
        return np.asarray(np.einsum("ps,ps...->p...", weights, values[rows]))

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(p,) edge of the nearest point on the chords, and its parameter."""
        first, along = self.point[self.ends[0]], self.point[self.ends[1]] - self.point[self.ends[0]]
        length2 = np.maximum(dot(along, along), 1e-300)
        share, edge = np.empty(len(points)), np.empty(len(points), np.int64)
        for part in np.array_split(np.arange(len(points)), 1 + len(points) * len(first) // 10**6):
            t = np.einsum("pej,ej->pe", points[part, None] - first, along) / length2
            t = np.clip(t, 0, 1)
            gap = points[part, None] - first - t[..., None] * along
            best = np.argmin(np.einsum("pej,pej->pe", gap, gap), axis=1)
            edge[part], share[part] = best, t[np.arange(len(part)), best]
        return edge, share

    def feet(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(p,) edge and parameter of the nearest point on the curve through the vertices, and (p, 3)
        that point. Beyond an end the curve is straight, with a parameter below 0 or above 1.
        """
        edge, share = self.nearest(points)
        rows, weights = self.cubics
        cubics = np.einsum("bcs,bsj->cbj", weights, self.point[rows])
        for _ in range(NEWTON):
            c, t = cubics[:, edge], np.clip(share, 0, 1)[:, None]
            first = c[1] + t * (2 * c[2] + 3 * t * c[3])
            second = (2 * c[2] + 6 * t * c[3]) * (t == share[:, None])
            away = points - (c[0] + t * (c[1] + t * (c[2] + t * c[3])))
            away -= (share[:, None] - t) * first
            speed2 = dot(first, first)
            bend = dot(away, second)
            step = dot(away, first) / np.maximum(speed2 - bend, speed2 / 4)
            share = share + step
            for side, over in enumerate((-share, share - 1)):
                moved = (over > 0) & (self.links[edge, side] >= 0)
                edge = np.where(moved, self.links[edge, side], edge)
                over = np.minimum(over, 1)
                share = np.where(moved, 1 - over if side == 0 else over, share)
            if np.abs(step).max(initial=0) < EXACT:
                break
        return edge, share, points - away


@dataclass(frozen=True)
class Border(BorderCurve):
    """The border edges of a mesh, and its surface at their ends.

    By vertex, (k, 3): normal, and `inward`, across the border; bend: (k, 3, 3), the second fundamental
    form with that normal, positive where the surface turns towards it.
    """

    normal: np.ndarray
    inward: np.ndarray
    bend: np.ndarray
    # Of e pairs, a vertex's row and a point near; and (e, 2) the changes of the slope and of the curvature
    # across the border per move of each point along the normal.
    pairs: tuple[np.ndarray, np.ndarray]
    fits: np.ndarray

    def at(self, points: np.ndarray) -> Foot:
        """The nearest points on the border curve, which lie between its vertices too."""
        rows, weights = self.shares(*self.feet(points)[:2])
        every = (self.point, self.normal, self.inward, self.bend, self.along)
        place = [np.einsum("ps,ps...->p...", weights, values[rows]) for values in every]
        normal, inward, along = (unit_vectors(place[k]) for k in (1, 2, 4))
        return Foot(place[0], normal, inward, place[3], along)


@dataclass(frozen=True)
class Foot:
    """A border at p points: the quantities that Border has at vertices, (p, 3) and (p, 3, 3)."""

    point: np.ndarray
    normal: np.ndarray
    inward: np.ndarray
    bend: np.ndarray
    along: np.ndarray


def border_edges(corners: np.ndarray, offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(b, 2) edges with one face, which is on their left, and (b,) that face."""
    sizes = np.diff(offsets)
    edge = np.stack([corners, corners[following(offsets)]], axis=1)
    _, place, count = np.unique(pair_keys(edge), return_inverse=True, return_counts=True)
    single = np.flatnonzero(count[place.ravel()] == 1)
    return edge[single], np.repeat(np.arange(len(sizes)), sizes)[single]


def border_curve(
    points: np.ndarray, corners: np.ndarray, offsets: np.ndarray, only: np.ndarray | None = None
) -> BorderCurve:
    """The border's curve. `only`: (j,) the border vertices to take; None: all."""
    edge, face = border_edges(corners, offsets)
    if only is not None:
        kept = np.isin(edge, only).all(axis=1)
        edge, face = edge[kept], face[kept]
    vertex = np.unique(edge)
    slot = np.full(len(points), -1)
    slot[vertex] = np.arange(len(vertex))
    return BorderCurve(edge, face, vertex, points[vertex], slot)


def across(surface: Border | Foot, along: np.ndarray) -> np.ndarray:
    """(k, 3): unit vectors into the surface, in its tangent planes and at right angles to `along`."""
    way = unit_vectors(np.cross(surface.normal, along))
    return way * np.sign(dot(way, surface.inward))[:, None]


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(k,) the products of rows (k, 3)."""
    return np.asarray(np.einsum("ij,ij->i", a, b))


def unit_vectors(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.maximum(length, 1e-300)


def mesh_arrays(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, corners, offsets of (vertices, faces); faces may also be (triangles, quads)."""
    vertices, faces = mesh
    points = vertex_array(vertices)
    if isinstance(faces, tuple) and len(faces) == 2 and np.ndim(faces[0]) == 2:
        corners, offsets = joined_faces([np.asarray(part, np.int64) for part in faces])
    else:
        corners, offsets = face_arrays(faces)
    if not len(border_edges(corners, offsets)[0]):
        raise fairing_error("BAD_OPTION", "A mesh that is to meet another has no border.")
    return points, corners, offsets


@dataclass(frozen=True)
class Halfway:
    """The mean of two borders, seen from the first; seen from the other it is the same surface."""

    own: Border
    other: Border

    def at(self, points: np.ndarray) -> Foot:
        """As Border.at() of the other: `inward` is the other's way."""
        own, other = self.own.at(points), self.other.at(points)
        ways = [across(foot, own.along) for foot in (own, other)]
        along = np.cross(ways[1], other.normal)
        # the borders run in opposite directions, unless the faces of one are flipped
        same = -np.sign(dot(np.cross(ways[0], own.normal), along))
        inward = unit_vectors(ways[1] - ways[0])
        bends = [
            np.einsum("ki,kij,kj->k", way, foot.bend, way) for way, foot in zip(ways, (own, other))
        ]
        return Foot(
            (own.point + other.point) / 2,
            unit_vectors(np.cross(along, inward)),
            inward,
            ((bends[1] + same * bends[0]) / 2)[:, None, None]
            * inward[:, :, None]
            * inward[:, None, :],
            own.along,
        )
