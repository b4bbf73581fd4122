# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds and avoids fillings that cross the mesh, each other or themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import _native
from ..mesh_part import MeshPart
from ..watching import SeveralRuns
from .near_hole import NearHole, Wanted
from .rounds import Filling, Fillings


def in_whole(whole: MeshPart, part: MeshPart, fillings: Sequence[Filling]) -> list[Filling]:
    """The fillings of `part` with ids of the whole mesh; new vertices are numbered consecutively."""
    first, found = len(whole.points), []
    for f in fillings:
        is_old = f.faces < len(part.points)
        old = part.vertex_ids[np.where(is_old, f.faces, 0)]
        faces = np.where(is_old, old, f.faces - f.first + first)
        found.append(Filling(f.own, faces, first, f.made))
        first += len(f.own)
    return found


class Surroundings:
    """The faces of a mesh that fillings may cross. The whole mesh is searched once, for all fillings."""

    def __init__(self, whole: MeshPart) -> None:
        self.whole = whole
        self._low = self._high = np.full(3, np.nan)

    def near(self, boxes: np.ndarray) -> np.ndarray:
        """(t, 3) triangles of all faces that may intersect one of the boxes (k, 2, 3)."""
        low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
        if not ((self._low <= low).all() and (high <= self._high).all()):
            margin = np.linalg.norm(high - low) / 2.0
            self._low, self._high = low - margin, high + margin
            self._sort(_overlapping(self.whole, self._low, self._high))
        found = np.concatenate([self._inside(*box) for box in boxes])
        return self._triangles[np.unique(self._order[found])]

    def _sort(self, faces: np.ndarray) -> None:
        """Sorts faces by their least x, so that a box is compared with the faces of one slab."""
        self._triangles = self.whole.corner_fans(faces)
        a, b, c = np.ascontiguousarray(self._triangles.T)
        begins: list[np.ndarray] = []
        ends: list[np.ndarray] = []
        for along in np.ascontiguousarray(self.whole.points.T):
            for of, found in ((np.minimum, begins), (np.maximum, ends)):
                found.append(of(of(along[a], along[b]), along[c]))
        self._order = np.argsort(begins[0], kind="stable")
        self._begins, self._ends = ([of[self._order] for of in both] for both in (begins, ends))
        self._widest = float((self._ends[0] - self._begins[0]).max(initial=0.0))

    def _inside(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Positions, in the sorted order, of triangles that may intersect a box."""
        first = np.searchsorted(self._begins[0], low[0] - self._widest, "left")
        found = np.arange(first, np.searchsorted(self._begins[0], high[0], "right"))
        for axis in range(3):
            found = found[self._ends[axis][found] >= low[axis]]
            found = found[self._begins[axis][found] <= high[axis]]
        return found


def _overlapping(mesh: MeshPart, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Ids of the faces whose bounding boxes overlap a box."""
    sides = np.concatenate([mesh.points < low, mesh.points > high], axis=1)
    beyond = np.packbits(sides, axis=1)[:, 0]
    all_beyond = np.bitwise_and.reduceat(beyond[mesh.corners], mesh.offsets[:-1])
    return np.flatnonzero(all_beyond == 0)


def crossing_faces(
    around: Surroundings, fillings: Sequence[Filling], boxes: np.ndarray, watched: SeveralRuns
) -> list[np.ndarray]:
    """The faces of each of the first k `fillings` that cross a face of the mesh or of a filling. `boxes`
    (k, 2, 3) contain these fillings; ids are those of in_whole(). Faces that share a vertex do not count.
    """
    asked, count = len(boxes), len(around.whole.points)
    own = [f.faces for f in fillings]
    new = np.concatenate(own[:asked])
    faces = np.concatenate([around.near(boxes), *own[asked:], new])
    old = np.unique(faces[faces < count])
    number = np.where(faces < count, np.searchsorted(old, faces), faces - count + len(old))
    points = np.concatenate([around.whole.points[old], *(f.own for f in fillings)])
    first = len(faces) - len(new)
    found = _native._crossings(points, number.astype(np.int32), first, *watched.watchers(1.0))
    ends = np.cumsum([first, *map(len, own[:asked])])
    return [np.unique(found[(found >= a) & (found < b)] - a) for a, b in zip(ends[:-1], ends[1:])]


class _Chosen(Fillings):
    """Fillings of all holes and their crossings; single fillings may be replaced."""

    def __init__(
        self, whole: MeshPart, part: MeshPart, fillings: Sequence[Filling], watched: SeveralRuns
    ) -> None:
        self._whole, self._part, self._watched = whole, part, watched
        self._around = Surroundings(whole)
        self._boxes = np.empty((len(fillings), 2, 3))
        super().__init__(len(part.points), dict(enumerate(fillings)))

    def counts(self) -> list[int]:
        if not self.of:
            return []
        return list(map(len, self._crossing(list(self.of.values()), self._boxes)))

    def put(self, row: int, filling: Filling) -> None:
        super().put(row, filling)
        self._boxes[row] = self._box(filling)

    def crossing(self, row: int) -> np.ndarray:
        low, high = self._boxes[row]
        beside = (self._boxes[:, 0] <= high) & (self._boxes[:, 1] >= low)
        others = np.setdiff1d(np.flatnonzero(beside.all(axis=1)), row)
        (found,) = self._crossing([self.of[k] for k in (row, *others)], self._boxes[[row]])
        return found

    def _crossing(self, fillings: Sequence[Filling], boxes: np.ndarray) -> list[np.ndarray]:
        numbered = in_whole(self._whole, self._part, fillings)
        return crossing_faces(self._around, numbered, boxes, self._watched)

    def _box(self, filling: Filling) -> tuple[np.ndarray, np.ndarray]:
        rim = self._part.points[filling.faces[filling.faces < len(self._part.points)]]
        places = np.concatenate([rim, filling.own])
        return places.min(axis=0), places.max(axis=0)


def with_less_crossing(
    whole: MeshPart,
    part: MeshPart,
    nears: Sequence[NearHole],
    fillings: Sequence[Filling],
    wanted: Wanted,
    watched: SeveralRuns,
) -> tuple[list[Filling], list[int]]:
    """The `fillings`, with ids of `part`, and the number of crossing faces of each. A filling that crosses
    is replaced by the first alternative without crossings and folds, or by the one with the fewest.
    Alternatives use the triangles of the first round, kept in `nears`: first the requested energy with
    the crossing or folding places fixed at their triangulation, then flatter surfaces.
    """
    chosen = _Chosen(whole, part, fillings, watched)
    counts = chosen.counts()
    tried = False
    for row, (near, filling) in enumerate(zip(nears, fillings, strict=True)):
        if not (counts[row] or filling.made.stands_in) or not chosen.have_room(row, near.faces):
            continue
        tried = True
        best, least = filling, (counts[row], filling.made.folds)
        last = len(near.faces), 0
        run = watched.run(1.0, 1.0)
        for moved, made in near.other_ways(wanted, run):
            chosen.put(row, Filling(moved, near.faces, near.first, made))
            faces = chosen.crossing(row)
            now = len(faces), made.folds
            if sum(now) < sum(last):
                near.hold(faces, moved)
            last = now
            if sum(now) < sum(least) or (best.made.stands_in and now <= least):
                best, least = chosen.of[row], now
            if not any(now):
                break
        chosen.put(row, best)
    return list(chosen.of.values()), chosen.counts() if tried else counts
