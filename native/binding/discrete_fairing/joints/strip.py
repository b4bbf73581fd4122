# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces at a border that meets a neighbour's.

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

from ..arrays import joined_faces
from ..control_mesh import ControlMesh
from ..errors import fairing_error
from ..lattice import Lattice
from .borders import Border, BorderCurve, Foot
from .halfway import Halfway
from .turning import Turning


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
