# SPDX-License-Identifier: GPL-3.0-or-later
"""What fills holes, faired in rounds: the triangles of each fit the shape that the one before has made."""

from __future__ import annotations

from collections.abc import Sequence
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
_SLIVER = 15.0


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


def faired_in_rounds(
    mesh: MeshPart,
    filler: _native.Filler,
    found: list[tuple[np.ndarray, np.ndarray]],
    wanted: Wanted,
    watched: SeveralRuns,
    rows: list[int],
) -> dict[int, Filling]:
    """The best that each of the holes `rows` got. `found`: of all holes the own vertices and triangles,
    as `filler` has them.
    """
    best: dict[int, Filling] = {}
    last: dict[int, Filling] = {}
    ranks: dict[int, _Rank] = {}
    flat = [0.0] * len(found)  # area of each before it was faired
    for turn in range(_MOST_ROUNDS):
        shares = 1.0 - 0.9 * np.linspace(0.5**turn, 0.5 ** (turn + 1), len(rows) + 1)
        first, left, onward = len(mesh.points), [], [own for own, _ in found]
        fair = []  # those of `left` whose steps have come to their end
        for row, (own, triangles) in enumerate(found):
            if row in rows:
                near = NearHole(mesh, own, triangles, first)
                at = rows.index(row)
                run = watched.run(*shares[at : at + 2].tolist())
                moved, made, onward[row] = near.faired(
                    wanted.energy, wanted.joint, wanted.noisy, run, stands_in=turn == 0
                )
                start = near.area(own)
                if turn == 0:
                    flat[row] = start
                last[row] = Filling(moved, triangles, first, made)
                rank = _rank(made, near.corners(moved), wanted)
                better = turn == 0 or rank < ranks[row]
                if turn == 0 or rank <= ranks[row]:
                    best[row], ranks[row] = last[row], rank
                area = near.area(onward[row])
                more = area > _GROWN * start or (better and rank > _FLAWLESS)
                if more and _may_go_on(own, wanted) and area < _MOST_GROWN * flat[row]:
                    left.append(row)
                    if made.converged and moved is onward[row]:
                        fair.append(row)
            first += len(own)
        rows = left
        if not rows or turn + 1 == _MOST_ROUNDS:
            break
        quiet = watched.run(float(shares[-1]), float(shares[-1]))
        watchers = quiet["monitor"], quiet["progress"]
        found = filler.refine(np.concatenate(onward), rows, fair, *watchers)
    return _apart(last, best, len(mesh.points))


def _apart(last: dict[int, Filling], best: dict[int, Filling], count: int) -> dict[int, Filling]:
    """The best of each hole; the last of one that would have an edge between vertices of the mesh, which
    has `count`, that another has: those of the last round have none.
    """
    chosen = dict(last)
    for row, filling in best.items():
        others = [f.faces for k, f in chosen.items() if k != row]
        if filling is not last[row] and not share_edges(filling.faces, others, count):
            chosen[row] = filling
    return chosen


_Rank = tuple[int, bool, bool, int]
_FLAWLESS: _Rank = (0, False, False, 0)


def _rank(made: Made, corners: np.ndarray, wanted: Wanted) -> _Rank:
    """The less the better; of triangles with these `corners` (t, 3, 3)."""
    after, before = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    slivers = (angles_between(after, before).min(axis=1) < np.radians(_SLIVER)).sum()
    return made.folds, made.energy != wanted.energy, not made.converged, int(slivers)


def _may_go_on(own: np.ndarray, wanted: Wanted) -> bool:
    return len(own) > 0 and wanted.density > 0.0 and wanted.joint != "position"


def without_folds(
    mesh: MeshPart, fillings: dict[int, Filling], bare: dict[int, tuple[np.ndarray, np.ndarray]]
) -> dict[int, Filling]:
    """`fillings`, and in the place of what folds the `bare` triangles between the vertices of the rim,
    where these do not: only what any such triangles would have is left to fold.
    """
    count = len(mesh.points)
    chosen = dict(fillings)
    first = count
    for k, (own, triangles) in bare.items():
        if k in chosen and chosen[k].made.folds:
            plain = NearHole(mesh, own, triangles, first).as_triangulated(True)
            others = [f.faces for row, f in chosen.items() if row != k]
            if not plain.folds and not share_edges(triangles, others, count):
                chosen[k] = Filling(own, triangles, first, plain)
        first += len(own)
    return chosen


def numbered_on(fillings: Sequence[Filling], count: int) -> list[Filling]:
    """The same, whose own vertices follow on one another from `count` on."""
    fresh, found = count, []
    for f in fillings:
        faces = np.where(f.faces < count, f.faces, f.faces - f.first + fresh)
        found.append(Filling(f.own, faces, fresh, f.made))
        fresh += len(f.own)
    return found


def share_edges(faces: np.ndarray, others: Sequence[np.ndarray], count: int) -> bool:
    """Whether some edge between two vertices of the mesh, which has `count`, is in both."""
    keys = _keys(faces, count)
    return any(np.isin(keys, _keys(other, count)).any() for other in others)


def _keys(faces: np.ndarray, count: int) -> np.ndarray:
    """A number for each side between two vertices of the mesh."""
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], -1).reshape(-1, 2).astype(np.int64)
    sides = np.sort(sides[sides.max(axis=1) < count], axis=1)
    return sides[:, 0] * count + sides[:, 1]
