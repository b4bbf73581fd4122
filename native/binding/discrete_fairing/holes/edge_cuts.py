# SPDX-License-Identifier: GPL-3.0-or-later
"""Sides of faces cut at the vertices of other faces that lie on them. Triangles become triangles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..arrays import following
from .rounds import SLIVER

Cuts = dict[tuple[int, int], list[int]]  # by the ends of a face's side, in its direction
Corner = tuple[int, int]  # a vertex, and the input corner from which it is copied


def cuts_for(
    points: np.ndarray, corners: np.ndarray, offsets: np.ndarray, loops: Iterable[Sequence[int]]
) -> Cuts:
    """The sides to cut of border loops without area, where only slivers would fit between."""
    found = [ids for loop in loops for ids in _on_sides(points, np.asarray(loop))]
    if not found:
        return {}
    both = [*found, *(ids[::-1] for ids in found)]
    sides = corners * len(points) + corners[following(offsets)]
    are_sides = np.isin([ids[0] * len(points) + ids[-1] for ids in both], sides)
    return {(ids[0], ids[-1]): ids[1:-1] for ids, is_side in zip(both, are_sides) if is_side}


def _on_sides(points: np.ndarray, loop: np.ndarray) -> list[list[int]]:
    """Sides of a loop with the vertices on them, if the loop runs to and fro along a line."""
    away = points[loop] - points[loop[0]]
    loop = np.roll(loop, -np.argmax((away * away).sum(axis=1)))
    way = points[loop] - points[loop[0]]
    squares = (way * way).sum(axis=1)
    turn = int(np.argmax(squares))
    along = way @ way[turn] / max(squares[turn], np.finfo(float).tiny)
    there, back = np.arange(turn + 1), np.r_[0, np.arange(len(loop) - 1, turn - 1, -1)]
    if any((np.diff(along[rows]) <= 0.0).any() for rows in (there, back, np.argsort(along))):
        return []
    found = []
    for chain, others in ((there, back[1:-1]), (back, there[1:-1])):
        for a, b in zip(chain, chain[1:]):
            between = others[(along[a] < along[others]) & (along[others] < along[b])]
            if len(between):
                rows = np.r_[a, between, b]
                if not _lie_on(way[rows]):
                    return []
                found.append(loop[rows].tolist())
    return found


def _lie_on(points: np.ndarray) -> bool:
    """Whether points (k, 3) lie on the side from the first to the last, up to slivers."""
    side = points[-1] - points[0]
    along = (points - points[0]) @ side / (side @ side)
    off = np.linalg.norm(points - points[0] - along[:, None] * side, axis=1)
    room = np.minimum(along, 1.0 - along) * np.linalg.norm(side) * np.tan(np.radians(SLIVER))
    return bool((np.diff(along) > 0.0).all() and (off <= room)[1:-1].all())


def sides_of(loop: Sequence[int]) -> set[tuple[int, int]]:
    """The sides of a loop, in both directions."""
    ids = list(map(int, loop))
    sides = list(zip(ids, ids[1:] + ids[:1]))
    return {*sides, *(side[::-1] for side in sides)}


def pieces(corners: np.ndarray, offsets: np.ndarray, cuts: Cuts) -> dict[int, list[list[Corner]]]:
    """The pieces of the faces with these sides, by face id."""
    begins = np.flatnonzero(np.isin(corners, [begin for begin, _ in cuts]))
    found = {}
    for face in np.unique(np.searchsorted(offsets, begins, side="right") - 1).tolist():
        rows = range(*offsets[face : face + 2].tolist())
        its = _cut([(int(corners[k]), k) for k in rows], cuts)
        if its[0] != [(int(corners[k]), k) for k in rows]:
            found[face] = its
    return found


def cut_faces(
    corners: np.ndarray, offsets: np.ndarray, cuts: Cuts
) -> tuple[np.ndarray, np.ndarray]:
    """Faces with these sides cut: the first piece of each in its place, all others last."""
    parts, sizes, more, at = [], np.diff(offsets).tolist(), [], 0
    for face, (first, *others) in pieces(corners, offsets, cuts).items():
        parts += [corners[at : offsets[face]], np.array([v for v, _ in first], np.int64)]
        at, sizes[face] = offsets[face + 1], len(first)
        more += [[v for v, _ in piece] for piece in others]
    parts += [corners[at:], np.array(more, np.int64).ravel()]
    sizes += map(len, more)
    return np.concatenate(parts), np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)


def _cut(face: list[Corner], cuts: Cuts) -> list[list[Corner]]:
    whole: list[Corner] = []
    for k, corner in enumerate(face):
        after = face[(k + 1) % len(face)]
        between = [(v, corner[1]) for v in cuts.get((corner[0], after[0]), [])]
        whole += [corner, *between]
        if between and len(face) == 3:
            fan = [corner, *between, after]
            triangles = [[face[k - 1], a, b] for a, b in zip(fan, fan[1:])]
            return [piece for triangle in triangles for piece in _cut(triangle, cuts)]
    return [whole]
