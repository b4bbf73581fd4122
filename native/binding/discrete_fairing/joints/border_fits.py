# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangent planes and curvatures of a mesh at its border, from polynomials through the vertices around."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .. import _native
from ..arrays import faces_by_vertex, following, ranges
from .borders import Border, BorderCurve, border_curve, dot, unit_vectors

# The polynomial at a border vertex: rings of faces that it is fitted to, and its degree. On two halves of
# an analytic sheet with 16 faces a side the measured kink is 0.001 degrees (triangles 0.007); with three
# rings and cubics it is 0.03.
RINGS, DEGREE = 5, 5
# Squared distance, of the farthest point's, at which the weight in that fit is halved.
SOFT = 0.1
# A fit's frame is settled when the polynomial rises by less: its normal is then exact to the square.
LEVEL = 1e-4
# The least sine of the angle between a term's column and those before: normal equations have 1e-8 of noise.
FULL_RANK = 1e-6


def border_of(
    points: np.ndarray, corners: np.ndarray, offsets: np.ndarray, only: np.ndarray | None = None
) -> Border:
    """The border of a mesh, or `only` some of its vertices, as in border_curve(). A vertex where two
    borders meet, and a corner, have the values of one of them.
    """
    return BorderFits(corners, offsets, only).of(points)


class BorderFits:
    """The border of a mesh, for points that move."""

    def __init__(self, corners: np.ndarray, offsets: np.ndarray, only: np.ndarray | None = None):
        count = int(corners.max(initial=-1)) + 1
        self.curve = border_curve(np.zeros((count, 3)), corners, offsets, only)
        self.around = _Around(corners, offsets)
        vertex = self.curve.vertex
        rings = self.around.rings(vertex, RINGS)
        near = [found[found != v] for found, v in zip(rings, vertex)]
        sizes = [len(found) for found in near]
        self.degree = np.array([_degree(size) for size in sizes], np.int64)
        self.begin = np.cumsum([0, *sizes])
        self.pairs = (
            np.repeat(np.arange(len(vertex)), sizes),
            np.concatenate([np.empty(0, np.int64), *near]),
        )
        self.up = np.empty((0, 3))  # normals to begin with; none at first
        self.last: tuple[np.ndarray, Border] | None = None

    def curve_of(self, points: np.ndarray) -> BorderCurve:
        """Its curve with these points (N, 3), or more."""
        place = points[self.curve.vertex]
        if not np.array_equal(place, self.curve.point):
            self.curve = replace(self.curve, point=place)
        return self.curve

    def of(self, points: np.ndarray) -> Border:
        """The border with these points (N, 3), or more, not changed since the last call; its fits begin with
        the last normals.
        """
        if self.last is not None and self.last[0] is points:
            return self.last[1]
        curve = self.curve_of(points)
        along = curve.along
        if not len(self.up):
            up = self.around.normals(points, curve.vertex)
        else:  # in its plane lies the surface's tangent, which differs a little from the curve's
            up = self.up
            along = unit_vectors(along - dot(along, up)[:, None] * up)
        found, fits = _native.border_fits(
            points,
            curve.vertex,
            self.begin,
            self.pairs[1],
            self.degree,
            along,
            up,
            SOFT,
            LEVEL,
            FULL_RANK,
        )
        normal, inward = np.ascontiguousarray(found[:, :3]), found[:, 3:6]
        bend = found[:, 6:].reshape(-1, 3, 3)
        place = (curve.edge, curve.face, curve.vertex, curve.point, curve.slot)
        border = Border(*place, normal, inward, bend, self.pairs, fits)
        vars(border).update(vars(curve))  # with the curve's tables
        self.up = normal
        self.last = points, border
        return border


class _Around:
    """The faces around each vertex, and their corners."""

    def __init__(self, corners: np.ndarray, offsets: np.ndarray):
        self.corners, self.offsets = corners, offsets
        count = int(corners.max(initial=0)) + 1
        self.face, self.begin = faces_by_vertex(corners, offsets, count)

    def rings(self, vertex: np.ndarray, count: int) -> list[np.ndarray]:
        """For each vertex: the vertices within `count` rings of faces around it, and itself."""
        rows, found = np.arange(len(vertex)), vertex
        size = len(self.begin)
        for _ in range(count):
            of_pair, face = _ranges(self.begin[found], self.begin[found + 1])
            key = np.unique(rows[of_pair] * len(self.offsets) + self.face[face])
            rows, faces = np.divmod(key, len(self.offsets))
            of_pair, corner = _ranges(self.offsets[faces], self.offsets[faces + 1])
            rows, found = np.divmod(np.unique(rows[of_pair] * size + self.corners[corner]), size)
        return np.split(found, np.searchsorted(rows, np.arange(1, len(vertex))))

    def normals(self, points: np.ndarray, vertex: np.ndarray) -> np.ndarray:
        """For each vertex: the sum of the normals of its faces, weighted by twice their areas."""
        of_vertex, place = _ranges(self.begin[vertex], self.begin[vertex + 1])
        face = self.face[place]
        of_face, corner = _ranges(self.offsets[face], self.offsets[face + 1])
        after = following(self.offsets)
        origin = points[vertex][of_vertex[of_face]]  # rounding would matter far from zero
        cross = np.cross(
            points[self.corners[corner]] - origin, points[self.corners[after[corner]]] - origin
        )
        total = np.zeros((len(vertex), 3))
        np.add.at(total, of_vertex[of_face], cross)
        return total


def _ranges(begin: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All numbers of the ranges [begin, end), one range after another, and the range of each number."""
    return np.repeat(np.arange(len(begin)), end - begin), ranges(begin, end)


def _degree(points: int) -> int:
    """Of the polynomial through so many points. Ends of joints between triangles have few, where a polynomial
    of lower degree would have another curvature than those beside.
    """
    return max(d for d in range(2, DEGREE + 1) if d == 2 or (d + 1) * (d + 2) // 2 + 2 <= points)
