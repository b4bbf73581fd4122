# SPDX-License-Identifier: GPL-3.0-or-later
"""The filling of a hole: its faces, the vertices around it, and values extended from its rim inside."""

from dataclasses import dataclass

import numpy as np

_RESIDUAL = 1e-7  # relative to the first one: colours and coordinates are single precision
_AT_ONCE = 1 << 20  # distances that are compared at a time: 8 MB


@dataclass(frozen=True)
class Patch:
    """Rows 0 … r - 1 are vertices of the rim, all others are new."""

    rim: np.ndarray  # (r,) ids in the mesh, ascending
    fresh: np.ndarray  # (k,) ids of the new vertices, which follow those of the mesh
    points: np.ndarray  # (r + k, 3)
    faces: list[np.ndarray]  # rows, an array (t, k) for each size k of faces
    nearest: np.ndarray  # (r + k,) row of the nearest vertex of the rim

    @property
    def triangles(self) -> np.ndarray:
        """(t, 3) rows: its faces as fans."""
        return np.concatenate(
            [its[:, [0, k, k + 1]] for its in self.faces for k in range(1, its.shape[1] - 1)]
        )

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


def spread(points: np.ndarray, triangles: np.ndarray, known: np.ndarray) -> np.ndarray:
    """(n, c) values, from those of the first k rows, `known` (k, c), on a mesh of `points` (n, 3) and
    `triangles` (t, 3). Each other value is the mean of its neighbours', weighted by inverse edge
    lengths, so that all are between the least and the largest known one.
    """
    count, first = len(points), len(known)
    values = np.zeros((count, known.shape[1]))
    values[:first] = known
    pairs = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0).T
    length = np.linalg.norm(points[pairs[0]] - points[pairs[1]], axis=1)
    weight = 1.0 / np.maximum(length, np.finfo(np.float32).tiny)
    degree = _at(pairs[0], weight, count) + _at(pairs[1], weight, count)
    for column in values.T:
        # constants are reproduced exactly
        column[first:] = 0.5 * (column[:first].min() + column[:first].max())
        column[first:] += _correction(column, pairs, weight, degree, first)
    return values


def _at(rows: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    return np.bincount(rows, values, minlength=count)


def _correction(
    start: np.ndarray, pairs: np.ndarray, weight: np.ndarray, degree: np.ndarray, first: int
) -> np.ndarray:
    """The correction of start[first:], by conjugate gradients with a diagonal preconditioner."""

    def laplacian(x: np.ndarray) -> np.ndarray:
        flow = weight * (x[pairs[0]] - x[pairs[1]])
        return (_at(pairs[0], flow, len(x)) - _at(pairs[1], flow, len(x)))[first:]

    found, padded = np.zeros(len(start) - first), np.zeros(len(start))
    residual = -laplacian(start)
    scaled = residual / degree[first:]
    way, energy = scaled.copy(), residual @ scaled
    enough = _RESIDUAL**2 * energy
    for _ in range(len(found)):
        if energy <= enough:
            break
        padded[first:] = way
        bent = laplacian(padded)
        step = energy / (way @ bent)
        found += step * way
        residual -= step * bent
        scaled = residual / degree[first:]
        energy, before = residual @ scaled, energy
        way = scaled + (energy / before) * way
    return found
