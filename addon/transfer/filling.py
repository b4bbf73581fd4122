# SPDX-License-Identifier: GPL-3.0-or-later
"""The filling of a hole: its faces, the vertices around it, and values extended from its rim inside."""

from dataclasses import dataclass

import numpy as np

_AT_ONCE = 1 << 20  # distances that are compared at a time: 8 MB


@dataclass(frozen=True)
class Patch:
    """Rows 0 … r - 1 are vertices of the rim, all others are new."""

    rim: np.ndarray  # (r,) ids in the mesh, ascending
    fresh: np.ndarray  # (k,) ids of the new vertices, which follow those of the mesh
    points: np.ndarray  # (r + k, 3)
    faces: list[np.ndarray]  # rows, an array (t, k) for each size k of faces
    nearest: np.ndarray  # (r + k,) row of the nearest vertex of the rim

    @classmethod
    def of(cls, faces: list[np.ndarray], points: np.ndarray, new: np.ndarray) -> "Patch":
        """`faces` of ids, an array (t, k) for each size: of the mesh at `points`, then of the `new` ones."""
        ids = np.unique(np.concatenate([its.ravel() for its in faces]))
        split = int(np.searchsorted(ids, len(points)))
        fresh = ids[split:]
        spots = np.concatenate([points[ids[:split]], new[fresh - len(points)]])
        rows = [np.searchsorted(ids, its) for its in faces]
        return cls(ids[:split], fresh, spots, rows, _nearest(spots, split))


def _nearest(points: np.ndarray, known: int) -> np.ndarray:
    """(n,) the nearest of the first `known` points to each point."""
    centred = points - points[:known].mean(axis=0)
    rim = centred[:known]
    found = np.arange(len(points))
    step = max(1, _AT_ONCE // known)
    for begin in range(known, len(points), step):
        part = centred[begin : begin + step]
        # the part of the squared distances that depends on the vertex of the rim
        found[begin : begin + step] = ((rim**2).sum(axis=1) - 2.0 * part @ rim.T).argmin(axis=1)
    return found


def spread(points: np.ndarray, known: np.ndarray) -> np.ndarray:
    """(n, c) values at `points` (n, 3), from those of the first k, `known` (k, c): means, weighted by inverse
    squares of the distances, so that all are between the least and the largest known one.
    """
    first, values = len(known), np.empty((len(points), known.shape[1]))
    values[:first] = known
    middle = 0.5 * (known.min(axis=0) + known.max(axis=0))  # constants are reproduced exactly
    step = max(1, _AT_ONCE // first)
    for begin in range(first, len(points), step):
        away = points[begin : begin + step, None] - points[:first]
        weight = 1.0 / np.maximum((away**2).sum(axis=2), np.finfo(np.float32).tiny)
        mean = weight @ (known - middle) / weight.sum(axis=1, keepdims=True)
        values[begin : begin + step] = middle + mean
    return values
