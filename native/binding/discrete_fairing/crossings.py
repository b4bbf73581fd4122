# SPDX-License-Identifier: GPL-3.0-or-later
"""Fillings that pass through the mesh, through each other or through themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from . import _native
from .near_hole import MeshPart, NearHole
from .rounds import Filling, RimEdges, Wanted, numbered_on
from .watching import SeveralRuns


def in_whole(whole: MeshPart, part: MeshPart, fillings: Sequence[Filling]) -> list[Filling]:
    """With the ids of the whole mesh, of which `part` has the rims; new ids follow on one another."""
    numbered = numbered_on(fillings, len(part.points))
    fresh = len(whole.points) + np.arange(sum(len(f.own) for f in numbered))
    places = np.concatenate([part.vertex_ids, fresh])
    shift = len(whole.points) - len(part.points)
    return [Filling(f.own, places[f.faces], f.first + shift, f.made) for f in numbered]


class Surroundings:
    """What fillings may pass through, of a mesh: the whole is asked once, for what is around all."""

    def __init__(self, whole: MeshPart) -> None:
        self.whole = whole
        self._low = self._high = np.full(3, np.nan)

    def near(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(t, 3) triangles of all faces that may come into a box."""
        if not ((self._low <= low).all() and (high <= self._high).all()):
            margin = np.linalg.norm(high - low) / 2.0
            self._low, self._high = low - margin, high + margin
            self._sort(_overlapping(self.whole, self._low, self._high))
        begin = np.searchsorted(self._lows[:, 0], low[0] - self._widest, "left")
        slab = slice(begin, np.searchsorted(self._lows[:, 0], high[0], "right"))
        inside = (self._lows[slab] <= high).all(axis=1) & (self._highs[slab] >= low).all(axis=1)
        return self.whole.corner_fans(np.sort(self._faces[slab][inside]))

    def _sort(self, faces: np.ndarray) -> None:
        """By where they begin along x: a box asks those of one slab."""
        corners = self.whole.points[self.whole.corners_at(faces)]
        sizes = self.whole.offsets[faces + 1] - self.whole.offsets[faces]
        starts = np.cumsum(sizes) - sizes
        lows, highs = (of.reduceat(corners, starts) for of in (np.minimum, np.maximum))
        order = np.argsort(lows[:, 0], kind="stable")
        self._faces, self._lows, self._highs = faces[order], lows[order], highs[order]
        self._widest = float((highs[:, 0] - lows[:, 0]).max(initial=0.0))


def _overlapping(mesh: MeshPart, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Ids of the faces that are not all on one side of a box."""
    sides = np.concatenate([mesh.points < low, mesh.points > high], axis=1)
    beyond = np.packbits(sides, axis=1)[:, 0]
    all_beyond = np.bitwise_and.reduceat(beyond[mesh.corners], mesh.offsets[:-1])
    return np.flatnonzero(all_beyond == 0)


def crossing_faces(
    around: Surroundings, fillings: Sequence[Filling], watched: SeveralRuns, asked: int
) -> list[np.ndarray]:
    """Which faces of each of the first `asked` fillings, with ids as in_whole() has them, pass through a
    face of the mesh or of a filling. Faces that share a vertex do not.
    """
    points = np.concatenate([around.whole.points, *(f.own for f in fillings)])
    split = [_split(f.faces) for f in fillings]
    new = np.concatenate(split[:asked])
    places = points[np.unique(new)]
    near = around.near(places.min(axis=0), places.max(axis=0))
    faces = np.concatenate([near, *split[asked:], new])
    used = np.zeros(len(points), bool)
    used[faces] = True
    number = np.cumsum(used, dtype=np.int32) - 1
    first = len(faces) - len(new)
    quiet = watched.run(1.0, 1.0)
    found = _native._crossings(
        points[used], number[faces], first, quiet["monitor"], quiet["progress"]
    )
    ends = np.cumsum([first, *map(len, split[:asked])])
    return [
        np.unique((found[(found >= a) & (found < b)] - a) // (f.faces.shape[1] - 2))
        for f, a, b in zip(fillings, ends[:-1], ends[1:])
    ]


def _split(faces: np.ndarray) -> np.ndarray:
    """(t, 3) triangles of (f, 3) or of (f, 4), in their order."""
    corners = [[0, k, k + 1] for k in range(1, faces.shape[1] - 1)]
    return faces[:, corners].reshape(-1, 3)


class _Chosen:
    """Fillings of all holes, of which one after another may change: what they pass through."""

    def __init__(
        self, whole: MeshPart, part: MeshPart, fillings: Sequence[Filling], watched: SeveralRuns
    ) -> None:
        self.fillings = list(fillings)
        self._whole, self._part, self._watched = whole, part, watched
        self._around = Surroundings(whole)
        self._boxes = np.array([self._box(f) for f in fillings]).reshape(-1, 2, 3)

    def counts(self) -> list[int]:
        """How many faces of each cross."""
        if not self.fillings:
            return []
        return list(map(len, self._crossing(self.fillings, len(self.fillings))))

    def put(self, row: int, filling: Filling) -> None:
        self.fillings[row] = filling
        self._boxes[row] = self._box(filling)

    def crossing(self, row: int) -> np.ndarray:
        """Which faces of a filling cross."""
        low, high = self._boxes[row]
        beside = (self._boxes[:, 0] <= high) & (self._boxes[:, 1] >= low)
        others = np.setdiff1d(np.flatnonzero(beside.all(axis=1)), row)
        (found,) = self._crossing([self.fillings[k] for k in (row, *others)], 1)
        return found

    def _crossing(self, fillings: Sequence[Filling], asked: int) -> list[np.ndarray]:
        numbered = in_whole(self._whole, self._part, fillings)
        return crossing_faces(self._around, numbered, self._watched, asked)

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
    """`fillings`, with ids of `part`, and how many faces of each cross. In the place of what crosses the
    first other way that neither crosses nor folds, or that with the fewest faces and edges that do, on the
    triangles of the first round, as `nears` has them: what was wanted, but for the places where it crosses
    or folds, which stay as they were triangulated; and flatter ones.
    """
    chosen = _Chosen(whole, part, fillings, watched)
    edges = RimEdges(len(part.points), {row: f.faces for row, f in enumerate(fillings)})
    counts = chosen.counts()
    tried = False
    for row, (near, filling) in enumerate(zip(nears, fillings, strict=True)):
        if (
            not (counts[row] or filling.made.stands_in)
            or filling.faces.shape[1] != 3
            or edges.are_taken(near.faces, row)
        ):
            continue
        tried = True
        best, least = filling, (counts[row], filling.made.folds)
        last = len(near.faces), 0
        run = watched.run(1.0, 1.0)
        for moved, made in near.other_ways(wanted.energy, wanted.joint, wanted.noisy, run):
            chosen.put(row, Filling(moved, near.faces, near.first, made))
            faces = chosen.crossing(row)
            now = len(faces), made.folds
            if sum(now) < sum(last):
                near.hold(faces, moved)
            last = now
            if sum(now) < sum(least) or (best.made.stands_in and now <= least):
                best, least = chosen.fillings[row], now
            if not any(now):
                break
        chosen.put(row, best)
        edges.put(row, best.faces)
    return chosen.fillings, chosen.counts() if tried else counts
