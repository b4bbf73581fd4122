# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations about a border that give it another surface's tangent planes and curvatures."""

from __future__ import annotations

import numpy as np

from ..arrays import marked
from .borders import Border, Foot, across, dot

# Steps of conjugate gradients, and the relative residual at which they end.
STEPS, LEFT = 2000, 1e-4
# A number of a full matrix takes a product so many times less long than one of a sparse.
FULL = 16


class Angles:
    """Rotations about a border: an angle at each vertex, times a profile for each kind of value.

    The response of the fits at the border to the angles is a sparse matrix: each fit covers several
    vertices, so correcting each vertex by its own error would not converge near ends.
    """

    def __init__(
        self,
        own: Border,
        ids: np.ndarray,
        lift: np.ndarray,
        profiles: list[np.ndarray],
        shares: tuple[np.ndarray, np.ndarray],
        reach: float,
    ):
        """ids: (p,) points; lift: (p, 3) their moves for a unit angle; profiles: (p,) each; shares:
        from Border.shares; reach: the length that converts curvatures to angles.
        """
        where = np.full(len(own.slot), -1)
        where[ids] = np.arange(len(ids))
        self.count = len(own.point)
        self.inside = marked(own.ends[1, own.links[:, 1] >= 0], self.count)
        self.units = [1, reach][: len(profiles)]
        self.profiles = [profile / unit for profile, unit in zip(profiles, self.units)]
        self.rows, self.weights = shares[0], self._from_lines(*shares)
        of = np.repeat(np.arange(self.count), [len(near) for near, _ in own.fits])
        point = where[np.concatenate([near for near, _ in own.fits])]
        fits = np.concatenate([fit for _, fit in own.fits], axis=1)[:, point >= 0]
        of, p = of[point >= 0], point[point >= 0]
        moves = dot(lift[p], own.normal[of])
        cells = (of[:, None] * self.count + self.rows[p]).ravel()
        entries = []
        # at ends no curvature: between triangles the fits hardly see it
        for row, (unit, seen) in enumerate(
            zip(self.units, (np.ones(len(of), bool), self.inside[of]))
        ):
            for column, profile in enumerate(self.profiles):
                values = (unit * seen * fits[row] * moves * profile[p])[:, None] * self.weights[p]
                sums = np.bincount(cells, values.ravel())
                at = np.flatnonzero(sums)
                place = row * self.count + at // self.count, column * self.count + at % self.count
                entries.append((*place, sums[at]))
        self.row, self.column, self.value = map(np.concatenate, zip(*entries))
        self.size = len(self.units) * self.count
        self.full: np.ndarray | None = None
        if self.size**2 <= FULL * len(self.value):
            self.full = np.zeros((self.size, self.size))
            np.add.at(self.full, (self.row, self.column), self.value)

    def _from_lines(self, rows: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """At ends the differences of the angles from the line through the two adjacent vertices: with
        zero angles beyond the end a joint would fold.
        """
        weights = weights.copy()
        for column, way in ((0, 1), (1, 1), (3, -1), (2, -1)):
            part = np.where(self.inside[rows[:, column]], 0, weights[:, column])
            weights[:, column + way] += 2 * part
            weights[:, column + 2 * way] -= part
        return weights

    def for_(self, wanted: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """(p, 1): angles with the `wanted` turns and changes of curvature in the fits; by conjugate
        gradients on the normal equations, stopped before insensitive components grow.
        """
        rows = (1, self.inside)
        left = np.concatenate([row * w * unit for row, w, unit in zip(rows, wanted, self.units)])
        found, enough = np.zeros(len(left)), LEFT**2 * (left @ left)
        way = slope = self._back(left)
        for _ in range(STEPS):
            if left @ left <= enough:
                break
            seen = self._seen(way)
            length = (slope @ slope) / max(seen @ seen, 1e-300)
            found, left = found + length * way, left - length * seen
            before, slope = slope @ slope, self._back(left)
            way = slope + (slope @ slope) / max(before, 1e-300) * way
        angle = np.zeros(len(self.rows))
        for profile, part in zip(self.profiles, np.split(found, len(self.units))):
            angle += profile * np.einsum("ps,ps->p", self.weights, part[self.rows])
        return angle[:, None]

    def _seen(self, way: np.ndarray) -> np.ndarray:
        if self.full is not None:
            return np.asarray(np.einsum("ij,j->i", self.full, way))
        return np.bincount(self.row, self.value * way[self.column], self.size)

    def _back(self, left: np.ndarray) -> np.ndarray:
        if self.full is not None:
            return np.asarray(np.einsum("ij,i->j", self.full, left))
        return np.bincount(self.column, self.value * left[self.row], self.size)


def needed(own: Border, foot: Foot) -> tuple[np.ndarray, np.ndarray]:
    """(k,) the angles about the border to the neighbour's tangent plane, and the change of curvature."""
    before, after = across(own, own.along), -across(foot, own.along)  # away from the neighbour
    turn = np.arctan2(dot(own.along, np.cross(before, after)), dot(before, after))
    side = np.sign(dot(np.cross(own.along, after), foot.normal))
    # Across the border only: along it both have the same curve, and errors of the fits would matter.
    old, new = (
        np.einsum("ki,kij,kj->k", way, of.bend, way) for way, of in ((before, own), (after, foot))
    )
    return turn, side * new - old


def rotation(vectors: np.ndarray, axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """The displacement of vectors by a rotation."""
    stays = dot(vectors, axis)[:, None] * axis
    return (np.cos(angle) - 1) * (vectors - stays) + np.sin(angle) * np.cross(axis, vectors)
