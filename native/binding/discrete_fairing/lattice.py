# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers the points of a refined surface in the order of native/grid/grid_level.h.

[control vertices | edge interiors, edge by edge | face interiors, face by face, row by row]

The n² cells of a control face follow one another, row by row from the face's first side to the opposite
corner or side; in a triangle's row upward and downward cells alternate.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from .arrays import pair_keys

# the cells along a side of a face, and the two of their corners on it
CellSide: TypeAlias = tuple[np.ndarray, int, int]


class Lattice:
    """The closed lattice of a control face whose edges are split into n: points (i, j), row by row.

    A triangle holds i + j <= n, a quad i, j <= n; i runs along side 0, j along the last side
    reversed.
    """

    def __init__(self, n: int, quad: bool):
        self.n, self.quad = n, quad
        self.size = 4 if quad else 3
        self.interior_count = (n - 1) ** 2 if quad else (n - 1) * (n - 2) // 2
        rows = [n if quad else n - j for j in range(n + 1)]
        self.i = np.concatenate([np.arange(last + 1) for last in rows])
        self.j = np.repeat(np.arange(n + 1), [last + 1 for last in rows])

    def at(self, i: Any, j: Any) -> Any:
        """Positions of points (i, j) in the closed lattice, for numbers or arrays."""
        return j * (self.n + 1) + i - (0 if self.quad else (j * j - j) // 2)

    @cached_property
    def corners(self) -> np.ndarray:
        n = self.n
        places = [(0, 0), (n, 0), (n, n), (0, n)] if self.quad else [(0, 0), (n, 0), (0, n)]
        return np.array([self.at(*place) for place in places])

    @cached_property
    def sides(self) -> np.ndarray:
        """(sides, n - 1): the points inside each side, from its own corner on."""
        n, k = self.n, np.arange(1, self.n)
        if self.quad:
            places = [(k, 0 * k), (n + 0 * k, k), (n - k, n + 0 * k), (0 * k, n - k)]
        else:
            places = [(k, 0 * k), (n - k, k), (0 * k, n - k)]
        return np.array([self.at(i, j) for i, j in places])

    @cached_property
    def cell_sides(self) -> list[CellSide]:
        """For each side its n cells in order, and the two of their corners on it."""
        n, run = self.n, np.arange(self.n)
        if self.quad:
            cells = [run, run * n + n - 1, n * (n - 1) + run[::-1], run[::-1] * n]
        else:
            row = n * n - (n - run) ** 2  # the first cell of each row
            cells = [2 * run, row + 2 * (n - run - 1), row[::-1]]
        return [(along, side, (side + 1) % self.size) for side, along in enumerate(cells)]

    @cached_property
    def interior(self) -> np.ndarray:
        last = self.n - self.j * (not self.quad)
        inside = (self.i > 0) & (self.j > 0) & (self.i < last) & (self.j < self.n)
        return np.flatnonzero(inside)

    @cached_property
    def cells(self) -> np.ndarray:
        """(cells, 3 or 4): the small faces, in the order of the result."""
        n, at = self.n, self.at
        out = []
        for j in range(n):
            if self.quad:
                i = np.arange(n)
                out.append(np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], 1))
                continue
            row = np.empty((2 * (n - j) - 1, 3), np.int64)
            i = np.arange(n - j)
            row[::2] = np.stack([at(i, j), at(i + 1, j), at(i, j + 1)], 1)
            i = i[:-1]
            row[1::2] = np.stack([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], 1)
            out.append(row)
        return np.concatenate(out)

    def closed(self, faces: np.ndarray) -> np.ndarray:
        """(F, closed): all points of F control faces, of the small `faces` in the order of the result."""
        points = np.empty((len(faces) // len(self.cells), len(self.i)), faces.dtype)
        points[:, self.cells.ravel()] = faces.reshape(len(points), self.cells.size)
        return points

    @cached_property
    def first_corner(self) -> np.ndarray:
        """(closed,): the first corner of a cell that lies at each point."""
        return np.unique(self.cells, return_index=True)[1]

    @cached_property
    def weights(self) -> np.ndarray:
        """(closed, corners): weights of the corners that interpolate linearly on the face."""
        n, i, j = self.n, self.i, self.j
        if self.quad:
            return np.stack([(n - i) * (n - j), i * (n - j), i * j, (n - i) * j], 1) / n**2
        return np.stack([n - i - j, i, j], 1) / n


def fine_edges(
    faces: tuple[np.ndarray, np.ndarray], control_pairs: np.ndarray, levels: int
) -> np.ndarray:
    """Vertex pairs (k, 2) of the refined edges into which the control edges `control_pairs` (c, 2) were
    split.

    `faces`: (triangles (T, 3), quads (Q, 4)). An edge between two faces occurs twice.
    """
    wanted = pair_keys(control_pairs)
    found = [np.empty((0, 2), np.int32)]
    for fine in faces:
        lattice = Lattice(2**levels, fine.shape[1] == 4)
        cells = fine.reshape(-1, lattice.n**2, lattice.size)  # by control face
        for run, start, end in lattice.cell_sides:
            ends = np.stack([cells[:, run[0], start], cells[:, run[-1], end]], axis=1)
            chosen = cells[np.isin(pair_keys(ends), wanted)][:, run]
            found.append(chosen[:, :, [start, end]].reshape(-1, 2))
    return np.concatenate(found)
