# SPDX-License-Identifier: GPL-3.0-or-later
"""Fillings that pass through the mesh, through each other or through themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from . import _native
from .near_hole import MeshPart, NearHole
from .rounds import Filling, Wanted, numbered_on, share_edges
from .watching import SeveralRuns


def in_whole(whole: MeshPart, part: MeshPart, fillings: Sequence[Filling]) -> list[Filling]:
    """With the ids of the whole mesh, of which `part` has the rims; new ids follow on one another."""
    numbered = numbered_on(fillings, len(part.points))
    fresh = len(whole.points) + np.arange(sum(len(f.own) for f in numbered))
    places = np.concatenate([part.vertex_ids, fresh])
    shift = len(whole.points) - len(part.points)
    return [Filling(f.own, places[f.faces], f.first + shift, f.made) for f in numbered]


class Surroundings:
    """What a filling may pass through, of a mesh: the whole is asked once, not for each of its shapes."""

    def __init__(self, whole: MeshPart) -> None:
        self.whole = whole
        self._low = self._high = np.full(3, np.nan)
        self._faces = np.empty((0, 3), np.int64)

    def near(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(t, 3) triangles of all faces that may come into a box, and of others around it."""
        if not ((self._low <= low).all() and (high <= self._high).all()):
            margin = np.linalg.norm(high - low) / 2.0
            self._low, self._high = low - margin, high + margin
            faces = _overlapping(self.whole, self._low, self._high)
            self._faces = self.whole.corner_fans(faces)
        return self._faces


def crossing_faces(
    around: Surroundings,
    fillings: Sequence[Filling],
    watched: SeveralRuns,
    rows: Sequence[int] | None = None,
) -> list[np.ndarray]:
    """Which faces of each filling, or of these `rows`, with ids as in_whole() has them, pass through a face
    of the mesh or of a filling. Faces that share a vertex do not.
    """
    rows = range(len(fillings)) if rows is None else rows
    points = np.concatenate([around.whole.points, *(f.own for f in fillings)])
    split = [_split(f.faces) for f in fillings]
    new = np.concatenate([split[row] for row in rows])
    places = points[np.unique(new)]
    near = around.near(places.min(axis=0), places.max(axis=0))
    near = np.concatenate([near, *(s for row, s in enumerate(split) if row not in rows)])
    quiet = watched.run(1.0, 1.0)
    found = _native._crossings(
        points,
        np.concatenate([near, new]).astype(np.int32),
        len(near),
        quiet["monitor"],
        quiet["progress"],
    )
    ends = np.cumsum([len(near), *(len(split[row]) for row in rows)])
    return [
        np.unique((found[(found >= a) & (found < b)] - a) // (fillings[row].faces.shape[1] - 2))
        for row, a, b in zip(rows, ends[:-1], ends[1:], strict=True)
    ]


def _split(faces: np.ndarray) -> np.ndarray:
    """(t, 3) triangles of (f, 3) or of (f, 4), in their order."""
    corners = [[0, k, k + 1] for k in range(1, faces.shape[1] - 1)]
    return faces[:, corners].reshape(-1, 3)


def _overlapping(mesh: MeshPart, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Ids of the faces that are not all on one side of a box."""
    sides = np.concatenate([mesh.points < low, mesh.points > high], axis=1)
    beyond = np.packbits(sides, axis=1)[:, 0]
    all_beyond = np.bitwise_and.reduceat(beyond[mesh.corners], mesh.offsets[:-1])
    return np.flatnonzero(all_beyond == 0)


def with_less_crossing(
    whole: MeshPart,
    part: MeshPart,
    triangulated: Sequence[tuple[np.ndarray, np.ndarray]],
    fillings: Sequence[Filling],
    wanted: Wanted,
    watched: SeveralRuns,
) -> tuple[list[Filling], list[int]]:
    """`fillings`, with ids of `part`, and how many faces of each cross. In the place of what crosses the
    first other way that neither crosses nor folds, or that with the fewest faces and edges that do, on the
    triangles of the first round: what was wanted, but for the places where it crosses or folds, which
    stay as they were triangulated; and flatter ones.
    """
    chosen = list(fillings)

    def crossing(around: Surroundings, rows: Sequence[int] | None = None) -> list[np.ndarray]:
        return crossing_faces(around, in_whole(whole, part, chosen), watched, rows)

    everything = Surroundings(whole)
    counts = list(map(len, crossing(everything))) if chosen else []
    first = len(part.points)
    tried = False
    for row, (own, triangles) in enumerate(triangulated):
        others = [f.faces for k, f in enumerate(chosen) if k != row]
        if (
            (counts[row] or chosen[row].made.stands_in)
            and chosen[row].faces.shape[1] == 3
            and not share_edges(triangles, others, len(part.points))
        ):
            tried = True
            near = NearHole(part, own, triangles, first)
            run, around = watched.run(1.0, 1.0), Surroundings(whole)
            best, least = chosen[row], (counts[row], chosen[row].made.folds)
            ways = near.other_ways(wanted.energy, wanted.joint, wanted.noisy, run)
            last = len(triangles), 0
            for moved, made in ways:
                chosen[row] = Filling(moved, triangles, first, made)
                (faces,) = crossing(around, [row])
                now = len(faces), made.folds
                if sum(now) < sum(last):
                    near.hold(faces, moved)
                last = now
                if sum(now) < sum(least) or (best.made.stands_in and now <= least):
                    best, least = chosen[row], now
                if not any(now):
                    break
            chosen[row] = best
        first += len(own)
    if tried:
        counts = list(map(len, crossing(everything)))
    return chosen, counts
