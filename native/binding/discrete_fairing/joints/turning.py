# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces at a border that meets a neighbour's: rotations about it give them the other's tangent planes and curvatures.

The faces that touch the border change, by rotations about it. From v = 0 on the border to v = 1 on the
sides that do not touch it, quintic Hermite polynomials fade the differences from the neighbour in
position, slope and curvature to zero: all control vertices and all other faces stay. The distances to
both are smooth, so no side between the faces folds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import _native
from ..arrays import joined_faces, marked
from ..control_mesh import ControlMesh
from ..errors import fairing_error
from ..lattice import Lattice
from .borders import Border, BorderCurve, Foot, Halfway, across, dot, unit_vectors

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


class Strip:
    """The faces at a border that meets a neighbour: only they change, except their sides off the
    border.
    """

    def __init__(self, faces: list[Face], edge: np.ndarray):
        joint = set(edge.ravel().tolist())
        sides = {(a, b): face.side_ids(k) for face in faces for k, (a, b) in face.sides()}
        missing = [pair for pair in map(tuple, edge.tolist()) if pair not in sides]
        if missing:
            raise fairing_error(
                "BAD_OPTION", "A mesh with a neighbour must be free of defects.", cure="Mend it."
            )
        touching = [face for face in faces if joint & set(face.corners)]
        self.joint = np.array([sides[a, b] for a, b in edge.tolist()])
        self.on = np.unique(self.joint)
        self.ids = np.unique(np.concatenate([face.ids for face in touching]))
        self.is_corner = np.isin(self.ids, np.concatenate([face.corners for face in touching]))
        rim = {
            tuple(sorted(pair)): sides[pair]
            for face in touching
            for _, pair in face.sides()
            if not joint & set(pair)
        }
        self.rim = list(rim.values())
        cells = [face.ids[face.lattice.cells] for face in touching]
        self.cells = ControlMesh.of(np.empty((0, 3)), *joined_faces(cells))

    def largest_fold(self, points: np.ndarray) -> float:
        """Between cells that share an edge, radians."""
        folds, inside = replace(self.cells, positions=points).fold_angles
        return float(np.radians(folds[inside].max()))

    def away(self, points: np.ndarray) -> np.ndarray:
        """Distance of each point from the sides that stay: zero there, smooth elsewhere, and the
        distance from the line if they form a straight one (Belyaev, Fayolle, Pasko, Signed Lp-distance
        fields, 2013).
        """
        weight = np.zeros(len(points))
        for side in self.rim:
            length = np.linalg.norm(np.diff(points[side], axis=0), axis=1) / 2
            np.add.at(weight, side[1:], length)
            np.add.at(weight, side[:-1], length)
        rim = np.flatnonzero(weight)
        out = np.empty(len(self.ids))
        for part in np.array_split(np.arange(len(out)), 1 + len(out) * len(rim) // 10**6):
            gap = np.linalg.norm(points[self.ids[part], None] - points[rim], axis=2)
            with np.errstate(divide="ignore"):
                out[part] = np.sqrt(2 / np.sum(weight[rim] / gap**3, axis=1))
        return out

    def inner_gap(self, own: BorderCurve, foot: Foot) -> np.ndarray:
        """(k, 3): difference from the neighbour's border, minus the linear part along each side, since
        ends stay.
        """
        gap = foot.point - own.point
        out = gap.copy()
        share = np.linspace(0, 1, self.joint.shape[1])[:, None]
        for rows in own.slot[self.joint]:
            out[rows] = gap[rows] - (1 - share) * gap[rows[0]] - share * gap[rows[-1]]
        return out

    def placed(self, points: np.ndarray, own: BorderCurve, goal: Border | Halfway) -> np.ndarray:
        """(N, 3): with the border on the goal's."""
        place, _, v = self.places(points, own)
        gap = self.inner_gap(own, goal.at(own.point))
        fade = (1 - v) ** 3 * (1 + 3 * v + 6 * v * v) * ~self.is_corner
        out = points.copy()
        out[self.ids] += fade[:, None] * own.between(gap, *place)
        return out

    def places(
        self, points: np.ndarray, own: BorderCurve
    ) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray, np.ndarray]:
        """(p,) of the strip: feet on the border, edge and parameter; distances; and v."""
        edge, share, foot = own.feet(points[self.ids])
        t = np.linalg.norm(points[self.ids] - foot, axis=1)
        return (edge, share), t, t / (t + self.away(points))

    def turning(self, points: np.ndarray, own: BorderCurve, joint: str) -> Turning:
        place, t, v = self.places(points, own)
        fade = (1 - v) ** 3 * ~(self.is_corner | np.isin(self.ids, self.on))
        profiles = {
            "tangent": [fade * (1 + 7 / 6 * v)],  # with the curvature of least bending
            "curvature": [fade * (1 + 3 * v), fade * t / 2],
        }[joint]
        return Turning(points, self.ids, own, place, profiles, float(t.mean()))


@dataclass(frozen=True)
class Face:
    """A refined control face with its points in lattice order."""

    lattice: Lattice
    ids: np.ndarray
    corners: list[int]

    def sides(self) -> Iterator[tuple[int, tuple[int, int]]]:
        return enumerate(zip(self.corners, self.corners[1:] + self.corners[:1]))

    def side_ids(self, k: int) -> np.ndarray:
        """(n + 1,): ids along side k, from its first corner."""
        begin, end = self.lattice.corners[[k, (k + 1) % self.lattice.size]]
        return np.asarray(self.ids[np.r_[begin, self.lattice.sides[k], end]])


def closed_faces(found: dict[str, Any], n: int) -> list[Face]:
    """All control faces, with split polygons in their pieces."""
    out = []
    for name, quad in (("triangles", False), ("quads", True)):
        lattice = Lattice(n, quad)
        for ids in lattice.closed(found[name].astype(np.int64)):
            out.append(Face(lattice, ids, ids[lattice.corners].tolist()))
    return out
