# SPDX-License-Identifier: GPL-3.0-or-later
"""Fairs fillings in rounds: the triangles of each round fit the shape of the previous one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .. import _native
from ..mesh_part import MeshPart, angles_between
from ..watching import SeveralRuns
from .near_hole import Made, NearHole, Wanted

# A filling is remeshed if fairing has enlarged its area by this factor. Below it the edges are within a
# tenth of the wanted length, and a second round only doubles the cost.
_GROWN = 1.2

# The flat filling of half a sphere has half the sphere's area: after fairing it gets new triangles of
# the wanted density and is faired again. If the flat filling folds at a ragged rim, the steps of an
# energy end early because triangles are stretched too far; new triangles let them continue. Of 20 such
# fillings on a torus and on machine parts 5 unfold in the second round, 3 in the third, none later. A
# round that mends nothing is the last: in a noisy scan 27 of 39 holes fold, after five rounds or two.
_MOST_ROUNDS = 5

# Nine tenths of a sphere have 20 times the area of the flat filling: steps that exceed it diverge.
_MOST_GROWN = 20.0

# Degrees: a triangle with a smaller angle is a sliver. New triangles on the faired shape have fewer
# slivers, unless the rim forces them.
SLIVER = 15.0


@dataclass(frozen=True, slots=True)
class Filling:
    """The filling of one hole: new vertices (k, 3), with ids from `first` on; faces (t, 3) of ids."""

    own: np.ndarray
    faces: np.ndarray
    first: int
    made: Made


def near_holes(mesh: MeshPart, found: Sequence[tuple[np.ndarray, np.ndarray]]) -> list[NearHole]:
    """The fillings of all holes, from the new vertices and triangles of each; ids are consecutive."""
    first, nears = len(mesh.points), []
    for own, triangles in found:
        nears.append(NearHole(mesh, own, triangles, first))
        first += len(own)
    return nears


def faired_in_rounds(
    mesh: MeshPart,
    filler: _native.Filler,
    nears: list[NearHole],
    wanted: Wanted,
    watched: SeveralRuns,
) -> dict[int, Filling]:
    """The best filling of each hole. `nears` has all holes, in the order of `filler`."""
    rows, movable = list(range(len(nears))), wanted.density > 0.0 and wanted.joint != "position"
    best: dict[int, Filling] = {}
    last: dict[int, Filling] = {}
    ranks: dict[int, _Rank] = {}
    flat: dict[int, float] = {}  # area of each filling before fairing
    for turn in range(_MOST_ROUNDS):
        shares = 1.0 - 0.9 * np.linspace(0.5**turn, 0.5 ** (turn + 1), len(rows) + 1)
        left, onward = [], [near.own for near in nears]
        fair = []  # rows of `left` whose steps have converged
        for at, row in enumerate(rows):
            near = nears[row]
            run = watched.run(*shares[at : at + 2].tolist())
            moved, made, onward[row] = near.faired(wanted, run, stands_in=turn == 0)
            start = near.area(near.own)
            flat.setdefault(row, start)
            last[row] = Filling(moved, near.faces, near.first, made)
            rank = _rank(made, near.corners(moved), wanted)
            better = turn == 0 or rank < ranks[row]
            if turn == 0 or rank <= ranks[row]:
                best[row], ranks[row] = last[row], rank
            area = near.area(onward[row])
            more = area > _GROWN * start or (better and _is_mendable(made, rank))
            if more and movable and len(near.own) and area < _MOST_GROWN * flat[row]:
                left.append(row)
                if made.converged and moved is onward[row]:
                    fair.append(row)
        rows = left
        if not rows or turn + 1 == _MOST_ROUNDS:
            break
        watchers = watched.watchers(float(shares[-1]))
        nears = near_holes(mesh, filler.refine(np.concatenate(onward), rows, fair, *watchers))
    return _apart(last, best, len(mesh.points))


def _apart(last: dict[int, Filling], best: dict[int, Filling], count: int) -> dict[int, Filling]:
    """The best filling of each hole. If two fillings share an edge between vertices of the mesh (ids below
    `count`), the second one is replaced by that of the last round, where no fillings share edges.
    """
    chosen = Fillings(count, last)
    for row, filling in best.items():
        if filling is not last[row] and chosen.have_room(row, filling.faces):
            chosen.put(row, filling)
    return chosen.of


_Rank = tuple[int, bool, bool, int]
_FLAWLESS: _Rank = (0, False, False, 0)


def _is_mendable(made: Made, rank: _Rank) -> bool:
    """Whether new triangles may be better. If the steps have converged and only the fixed rim folds, they
    fold there again (of 13 such holes in a noisy scan none had fewer folds, six had more)."""
    only_the_rim = made.converged and made.folds > 0 and not made.folds_inside
    return rank > _FLAWLESS and not only_the_rim


def _rank(made: Made, corners: np.ndarray, wanted: Wanted) -> _Rank:
    """The rank of a filling with these triangles (t, 3, 3); a smaller rank is better."""
    after, before = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    slivers = (angles_between(after, before).min(axis=1) < np.radians(SLIVER)).sum()
    return made.folds, made.energy != wanted.energy, not made.converged, int(slivers)


def without_folds(
    mesh: MeshPart, fillings: dict[int, Filling], bare: dict[int, tuple[np.ndarray, np.ndarray]]
) -> dict[int, Filling]:
    """The `fillings`; a folding one is replaced by the `bare` triangles unless they fold."""
    chosen = Fillings(len(mesh.points), fillings)
    for row, near in zip(bare, near_holes(mesh, list(bare.values())), strict=True):
        plain = near.as_triangulated(True)
        if not plain.folds and chosen.have_room(row, near.faces):
            chosen.put(row, Filling(near.own, near.faces, near.first, plain))
    return chosen.of


class Fillings:
    """Fillings by the number of their hole, no two with a common edge between vertices of the mesh (ids below `count`)."""

    def __init__(self, count: int, fillings: Mapping[int, Filling]) -> None:
        self.of: dict[int, Filling] = {}
        self._count = count
        self._edges: dict[int, set[int]] = {}
        self._uses: Counter[int] = Counter()
        for row, filling in fillings.items():
            self.put(row, filling)

    def put(self, row: int, filling: Filling) -> None:
        self.of[row] = filling
        self._uses.subtract(self._edges.get(row, ()))
        self._edges[row] = self._keys(filling.faces)
        self._uses.update(self._edges[row])

    def have_room(self, row: int, faces: np.ndarray) -> bool:
        """Whether no other filling than `row` has an edge of these `faces`."""
        own = self._edges[row]
        return all(self._uses[key] <= (key in own) for key in self._keys(faces))

    def _keys(self, faces: np.ndarray) -> set[int]:
        """A number for each side between two vertices of the mesh."""
        sides = np.stack([faces, np.roll(faces, -1, axis=1)], -1).reshape(-1, 2).astype(np.int64)
        sides = np.sort(sides[sides.max(axis=1) < self._count], axis=1)
        return set((sides[:, 0] * self._count + sides[:, 1]).tolist())
