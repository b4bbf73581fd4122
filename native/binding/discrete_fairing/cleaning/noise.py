# SPDX-License-Identifier: GPL-3.0-or-later
"""The step that takes noise off: the one place where its method stands."""

from __future__ import annotations

import numpy as np

from .state import State

# Shares of the way to the middle of the neighbours, there and back again: what is longer than some
# seven edges keeps its size [Taubin 1995: a pass band of 0.1].
THERE, BACK = 0.6307, -0.6732


def without_noise(state: State, fixed: np.ndarray, passes: int) -> tuple[State, int]:
    """With vertices moved by so many passes of Taubin's filter; borders and what is `fixed`, (n,) bool,
    stay. Also how many have moved.
    """
    sides = state.sides
    begin, end = state.corners, state.corners[sides.next]
    free = ~fixed
    lone = sides.uses[sides.edge] != 2
    free[begin[lone]] = free[end[lone]] = False
    # each edge once: a border has no vertex that moves
    once = np.zeros(len(begin), bool)
    once[sides.order[sides.starts]] = True
    low, high = begin[once], end[once]
    weight = np.bincount(low, minlength=len(free)) + np.bincount(high, minlength=len(free))
    share = free / np.maximum(weight, 1)
    reached = free & (weight > 0)
    points = np.ascontiguousarray(state.points.T)
    for factor in (THERE, BACK) * passes:
        moved = []
        for x in points:
            total = np.bincount(low, x[high], len(x)) + np.bincount(high, x[low], len(x))
            moved.append(x + factor * (share * total - reached * x))
        points = np.stack(moved)
    return state.replaced(points=np.ascontiguousarray(points.T)), int(reached.sum())
