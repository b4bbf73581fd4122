# SPDX-License-Identifier: GPL-3.0-or-later
"""Values extended from a filling's rim inside: discrete harmonic, never beyond those of the rim."""

import numpy as np

_RESIDUAL = 1e-7  # relative to the first one: colours and coordinates are single precision


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
