# SPDX-License-Identifier: GPL-3.0-or-later
"""What fills holes, faired in rounds: the triangles of each fit the shape that the one before has made."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from . import _native
from .near_hole import Made, MeshPart, NearHole, angles_between
from .watching import SeveralRuns

# A filling is remeshed where fairing has made its area so many times as large: up to there its edges
# are within a tenth of the length wanted, and to fair it twice only costs as much again.
_GROWN = 1.2

# The flat filling of half a sphere has half the sphere's area: faired once, it gets new triangles of
# the density wanted, and is faired again. Where the flat filling folds at a ragged rim, the steps of
# an energy end early, in triangles that are stretched too far; on new ones they go on. Of 20 such
# fillings of a torus and of machine parts 5 unfold in the second round, 3 in the third, none later. A
# round that mends nothing is the last: of 39 holes in a noisy scan 27 fold, with five rounds or two.
_MOST_ROUNDS = 5

# Nine tenths of a sphere have 20 times the area of its flat filling: steps that make more have gone
# astray.
_MOST_GROWN = 20.0

# Degrees: a triangle with a smaller angle is a sliver. New triangles on the faired shape have fewer; a
# rim that forces some has as many in each round.
SLIVER = 15.0


@dataclass(frozen=True, slots=True)
class Wanted:
    """How holes shall be filled: as the arguments of fill_holes() have it."""

    energy: str
    joint: str
    noisy: bool
    density: float

    @property
    def triangles(self) -> tuple[float, bool]:
        """Their density, and whether they bend as the faces around do."""
        return self.density, self.joint != "position"


@dataclass(frozen=True, slots=True)
class Filling:
    """Of one hole: its own vertices (k, 3), whose ids begin with `first`; faces (t, 3 or 4) of ids."""

    own: np.ndarray
    faces: np.ndarray
    first: int
    made: Made


def near_holes(mesh: MeshPart, found: Sequence[tuple[np.ndarray, np.ndarray]]) -> list[NearHole]:
    """What fills all holes: own vertices and triangles of each, whose ids follow on one another."""
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
    rows: list[int],
) -> dict[int, Filling]:
    """The best that each of the holes `rows` got. `nears`: of all holes, as `filler` has them."""
    best: dict[int, Filling] = {}
    last: dict[int, Filling] = {}
    ranks: dict[int, _Rank] = {}
    flat: dict[int, float] = {}  # area of each before it was faired
    for turn in range(_MOST_ROUNDS):
        shares = 1.0 - 0.9 * np.linspace(0.5**turn, 0.5 ** (turn + 1), len(rows) + 1)
        left, onward = [], [near.own for near in nears]
        fair = []  # those of `left` whose steps have come to their end
        for at, row in enumerate(rows):
            near = nears[row]
            run = watched.run(*shares[at : at + 2].tolist())
            moved, made, onward[row] = near.faired(
                wanted.energy, wanted.joint, wanted.noisy, run, stands_in=turn == 0
            )
            start = near.area(near.own)
            flat.setdefault(row, start)
            last[row] = Filling(moved, near.faces, near.first, made)
            rank = _rank(made, near.corners(moved), wanted)
            better = turn == 0 or rank < ranks[row]
            if turn == 0 or rank <= ranks[row]:
                best[row], ranks[row] = last[row], rank
            area = near.area(onward[row])
            more = area > _GROWN * start or (better and _is_mendable(made, rank))
            if more and _may_go_on(near.own, wanted) and area < _MOST_GROWN * flat[row]:
                left.append(row)
                if made.converged and moved is onward[row]:
                    fair.append(row)
        rows = left
        if not rows or turn + 1 == _MOST_ROUNDS:
            break
        quiet = watched.run(float(shares[-1]), float(shares[-1]))
        watchers = quiet["monitor"], quiet["progress"]
        nears = near_holes(mesh, filler.refine(np.concatenate(onward), rows, fair, *watchers))
    return _apart(last, best, len(mesh.points))


def _apart(last: dict[int, Filling], best: dict[int, Filling], count: int) -> dict[int, Filling]:
    """The best of each hole; the last of one that would have an edge between vertices of the mesh, which
    has `count`, that another has: those of the last round have none.
    """
    chosen = dict(last)
    edges = RimEdges(count, {row: filling.faces for row, filling in last.items()})
    for row, filling in best.items():
        if filling is not last[row] and not edges.are_taken(filling.faces, row):
            chosen[row] = filling
            edges.put(row, filling.faces)
    return chosen


_Rank = tuple[int, bool, bool, int]
_FLAWLESS: _Rank = (0, False, False, 0)


def _is_mendable(made: Made, rank: _Rank) -> bool:
    """Whether new triangles may be better. Where all is found and only the rim folds, which stays, they fold
    there again (of 13 such holes in a noisy scan none had fewer folds, six had more)."""
    only_the_rim = made.converged and made.folds > 0 and not made.folds_inside
    return rank > _FLAWLESS and not only_the_rim


def _rank(made: Made, corners: np.ndarray, wanted: Wanted) -> _Rank:
    """The less the better; of triangles with these `corners` (t, 3, 3)."""
    after, before = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    slivers = (angles_between(after, before).min(axis=1) < np.radians(SLIVER)).sum()
    return made.folds, made.energy != wanted.energy, not made.converged, int(slivers)


def _may_go_on(own: np.ndarray, wanted: Wanted) -> bool:
    return len(own) > 0 and wanted.density > 0.0 and wanted.joint != "position"


def without_folds(
    mesh: MeshPart, fillings: dict[int, Filling], bare: dict[int, tuple[np.ndarray, np.ndarray]]
) -> dict[int, Filling]:
    """`fillings`, and in the place of some that fold the `bare` triangles between the vertices of the rim,
    where these do not: only what any such triangles would have is left to fold.
    """
    chosen = dict(fillings)
    edges = RimEdges(len(mesh.points), {row: filling.faces for row, filling in fillings.items()})
    for row, near in zip(bare, near_holes(mesh, list(bare.values())), strict=True):
        plain = near.as_triangulated(True)
        if not plain.folds and not edges.are_taken(near.faces, row):
            chosen[row] = Filling(near.own, near.faces, near.first, plain)
            edges.put(row, near.faces)
    return chosen


def numbered_on(fillings: Sequence[Filling], count: int) -> list[Filling]:
    """The same, whose own vertices follow on one another from `count` on."""
    fresh, found = count, []
    for f in fillings:
        faces = np.where(f.faces < count, f.faces, f.faces - f.first + fresh)
        found.append(Filling(f.own, faces, fresh, f.made))
        fresh += len(f.own)
    return found


class RimEdges:
    """Edges between two vertices of the mesh, which has `count`, that fillings have: faces of each by its
    row.
    """

    def __init__(self, count: int, faces: Mapping[int, np.ndarray]) -> None:
        self._count = count
        self._of: dict[int, set[int]] = {}
        self._uses: Counter[int] = Counter()
        for row, its in faces.items():
            self.put(row, its)

    def put(self, row: int, faces: np.ndarray) -> None:
        """The filling `row` has these `faces` from now on."""
        self._uses.subtract(self._of.get(row, ()))
        self._of[row] = self._keys(faces)
        self._uses.update(self._of[row])

    def are_taken(self, faces: np.ndarray, row: int) -> bool:
        """Whether another filling than `row` has an edge of these `faces`."""
        own = self._of.get(row, set())
        return any(self._uses[key] > (key in own) for key in self._keys(faces))

    def _keys(self, faces: np.ndarray) -> set[int]:
        """A number for each side between two vertices of the mesh."""
        sides = np.stack([faces, np.roll(faces, -1, axis=1)], -1).reshape(-1, 2).astype(np.int64)
        sides = np.sort(sides[sides.max(axis=1) < self._count], axis=1)
        return set((sides[:, 0] * self._count + sides[:, 1]).tolist())
