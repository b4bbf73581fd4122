# SPDX-License-Identifier: GPL-3.0-or-later
"""The lattice that one control face is refined to, as index tables: plain arrays, no Blender.

A point (i, j) lies i steps along the face's first side and j steps along its last one; `lattice.py` has the cells' order.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Cells:
    """The P points and n² cells of a control face with k corners."""

    points: np.ndarray  # (P, 2) int32: i, j
    corner_point: np.ndarray  # (n² k,) int32: the point at each corner of each cell
    first_corner: np.ndarray  # (P,) int32: a corner that lies at each point
    weights: np.ndarray  # (P, k) float64, whole numbers: how much each corner of the face counts
    total: float  # what the weights of a point add up to, a power of two

    @property
    def apex(self):
        """The point at the last corner."""
        return int(np.argmax(self.weights[:, -1]))


def make_cells(corners, levels):
    """Cells of a triangle (`corners` 3) or quad (4) that is refined `levels` times."""
    n = 2**levels
    points, corner_point = _triangle(n) if corners == 3 else _quad(n)
    i, j = points.T.astype(np.float64)
    if corners == 3:
        weights, total = [n - i - j, i, j], n
    else:
        weights, total = [(n - i) * (n - j), i * (n - j), i * j, (n - i) * j], n * n
    first_corner = np.empty(len(points), np.int32)
    first_corner[corner_point[::-1]] = np.arange(len(corner_point), dtype=np.int32)[::-1]
    return Cells(points, corner_point, first_corner, np.stack(weights, axis=1), float(total))


def _quad(n):
    at = np.arange((n + 1) ** 2, dtype=np.int32).reshape(n + 1, n + 1)  # by row j and step i
    j, i = np.divmod(np.arange((n + 1) ** 2, dtype=np.int32), n + 1)
    corners = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2)
    return np.stack([i, j], axis=1), corners.ravel()


def _triangle(n):
    at = np.full((n + 1, n + 1), -1, np.int32)
    j, i = np.nonzero(np.add.outer(np.arange(n + 1), np.arange(n + 1)) <= n)
    at[j, i] = np.arange(len(i))
    rows = []
    for low, high in zip(at[:-1], at[1:]):
        width = int((high >= 0).sum())
        cells = np.full((2 * width, 3), -1, np.int32)
        cells[0::2] = np.stack([low[:width], low[1 : width + 1], high[:width]], axis=1)
        cells[1:-1:2] = np.stack([low[1:width], high[1:width], high[: width - 1]], axis=1)
        rows.append(cells[:-1])
    return np.stack([i, j], axis=1).astype(np.int32), np.concatenate(rows).ravel()
