# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations about a border that give it another surface's tangent planes and curvatures."""

from __future__ import annotations

import numpy as np

from .. import _native
from ..arrays import marked
from .borders import Border, BorderCurve, Foot, across, dot, unit_vectors

# Steps of conjugate gradients, and the relative residual at which they end.
STEPS, LEFT = 2000, 1e-4


class Turning:
    """Points that turn about a border by angles: one at each vertex, times a profile for each kind of value.

    The response of the fits at the border to the angles is a sparse matrix: each fit covers several
    vertices, so correcting each vertex by its own error would not converge near ends.
    """

    def __init__(
        self,
        points: np.ndarray,
        ids: np.ndarray,
        curve: BorderCurve,
        place: tuple[np.ndarray, np.ndarray],
        profiles: list[np.ndarray],
        reach: float,
    ):
        """points: (N, 3), of which `ids` (p,) turn; place: (p,) their feet on the curve, edge and parameter;
        profiles: (p,) each; reach: the length that converts curvatures to angles.
        """
        self.start, self.ids, self.count = points, ids, len(curve.point)
        self.axis = unit_vectors(curve.between(curve.along, *place))
        self.arm = points[ids] - curve.between(curve.point, *place)
        self.inside = marked(curve.ends[1, curve.links[:, 1] >= 0], self.count)
        self.units = [1, reach][: len(profiles)]
        self.size = len(profiles) * self.count  # of the vectors of angles
        self.profiles = [profile / unit for profile, unit in zip(profiles, self.units)]
        self.rows, weights = curve.shares(*place)
        self.weights = self._from_lines(weights)

    def _from_lines(self, weights: np.ndarray) -> np.ndarray:
        """At ends the differences of the angles from the line through the two adjacent vertices: with
        zero angles beyond the end a joint would fold.
        """
        for column, way in ((0, 1), (1, 1), (3, -1), (2, -1)):
            part = np.where(self.inside[self.rows[:, column]], 0, weights[:, column])
            weights[:, column + way] += 2 * part
            weights[:, column + 2 * way] -= part
        return weights

    def turns(self, angles: np.ndarray) -> np.ndarray:
        """(p,): by `angles`, those at vertices for each profile."""
        out = np.zeros(len(self.ids))
        for profile, part in zip(self.profiles, np.split(angles, len(self.units))):
            out += profile * np.einsum("ps,ps->p", self.weights, part[self.rows])
        return out

    def moves(self, angles: np.ndarray) -> np.ndarray:
        """(p,): lengths with signs, of small turns."""
        return self.turns(angles) * np.linalg.norm(self.arm, axis=1)

    def arms(self, angles: np.ndarray) -> np.ndarray:
        """(p, 3): from the feet, after the turns."""
        return self.arm + rotation(self.arm, self.axis, self.turns(angles)[:, None])

    def points(self, angles: np.ndarray) -> np.ndarray:
        """(N, 3): all points after the turns."""
        out = self.start.copy()
        out[self.ids] += self.arms(angles) - self.arm
        return out

    def change(
        self, angles: np.ndarray, own: Border, wanted: tuple[np.ndarray, np.ndarray]
    ) -> np.ndarray:
        """Of the angles: with the `wanted` turns and changes of curvature in the fits, by least squares
        that end before insensitive components grow.
        """
        where = np.full(len(self.start), -1)
        where[self.ids] = np.arange(len(self.ids))
        on = np.flatnonzero(where[own.pairs[1]] >= 0)
        of, p = own.pairs[0][on], where[own.pairs[1][on]]
        lift = np.cross(self.axis, self.arms(angles))
        moves = own.fits[on] * dot(lift[p], own.normal[of])[:, None]
        # at ends no curvature: between triangles the fits hardly see it
        moves[:, 1] *= self.inside[of]
        entries: list[tuple[np.ndarray, ...]] = []
        right: list[np.ndarray] = []
        for kind, (unit, want) in enumerate(zip(self.units, wanted)):
            right.append(unit * want * (self.inside if kind else 1))
            for index, profile in enumerate(self.profiles):
                values = (unit * moves[:, kind] * profile[p])[:, None] * self.weights[p]
                place = np.repeat(kind * self.count + of, 4), index * self.count + self.rows[p]
                entries.append((place[0], place[1].ravel(), values.ravel()))
        row, column, value = map(np.concatenate, zip(*entries))
        return _native.damped_solution(
            row, column, value, self.size, np.concatenate(right), STEPS, LEFT
        )


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
