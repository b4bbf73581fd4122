# SPDX-License-Identifier: GPL-3.0-or-later
"""Number of control mesh edges on each arc, such that every cell can be filled with quads."""

from collections.abc import Sequence

import numpy as np

from .cells import Cell

_ROUNDS = 200
# earlier counts are kept while edge lengths, relative to the wanted ones, differ by at most this factor
_KEPT = 2.5
_MOST = 16  # times the wanted number of edges: the limit for raising counts


def edge_counts(
    cells: Sequence[Cell], lengths: np.ndarray, edge: float, before: np.ndarray | None = None
) -> tuple[np.ndarray, bool]:
    """((e,) int, whether sides are as in `cells`): edges of about the length `edge` on arcs of
    `lengths` (e,). Opposite sides of four have equal numbers; all sides of other cells have the same
    even number.

    If there is no such solution, all arcs get the same even number, and each arc of a cell concerned
    must be a side. `before` (e,): numbers to keep while they still fit, so that a mesh keeps its faces
    while curves are edited.
    """
    wanted = np.maximum(np.rint(lengths / edge).astype(int), 2)
    if before is not None and len(before) == len(wanted):
        change = np.maximum(before, 1) / wanted
        if change.max() < _KEPT * change.min() and _KEPT**-0.5 < np.median(change) < _KEPT**0.5:
            wanted = before.copy()
    counts = wanted.copy()
    for _ in range(_ROUNDS):
        before = counts.copy()
        for cell in cells:
            sides = [[half // 2 for half in side] for side in cell.sides]
            for group in _equal(sides):
                _raise(counts, lengths, [sides[k] for k in group], even=len(sides) != 4)
        if (counts == before).all():
            return counts, True
        if counts.sum() > _MOST * wanted.sum():
            break
    most = int(np.median(wanted)) + 1
    return np.full(len(lengths), most // 2 * 2), False


def _equal(sides: list[list[int]]) -> list[list[int]]:
    if len(sides) == 1:
        return [[0]]
    return [[0, 2], [1, 3]] if len(sides) == 4 else [list(range(len(sides)))]


def _raise(counts: np.ndarray, lengths: np.ndarray, sides: list[list[int]], even: bool) -> None:
    """Adds edges to the sides with fewer, on their arcs with the longest edges."""
    goal = max(int(counts[side].sum()) for side in sides)
    if len(sides) == 1:
        goal += -goal % 4  # a loop without corners is divided into four sides
    elif even:
        goal += goal % 2
    for side in sides:
        while counts[side].sum() < goal:
            counts[max(side, key=lambda k: lengths[k] / counts[k])] += 1
