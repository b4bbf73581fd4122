# SPDX-License-Identifier: GPL-3.0-or-later
"""The lattice that a control face is refined to: its points, cells and sides. Plain arrays, no
Blender.

The core writes the N² cells (N = 2^levels) of a control face one after another, row by row from the
face's first side to the opposite corner or side; in a triangle's row upward and downward cells
alternate. A point (i, j) lies i steps along the face's first side and j steps along its last one.
"""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

# the cells along a side of a face, and which two of their corners lie on it
Side: TypeAlias = tuple[np.ndarray, int, int]


def fine_edges(
    faces: tuple[np.ndarray, np.ndarray], control_pairs: np.ndarray, levels: int
) -> np.ndarray:
    """Vertex pairs (k, 2) of the refined edges that the control edges `control_pairs` (c, 2) were
    split into.

    `faces`: the core's (triangles (T, 3), quads (Q, 4)). An edge between two faces comes twice.
    """
    wanted = pair_keys(np.asarray(control_pairs))
    n = 2**levels
    found = [np.empty((0, 2), np.int32)]
    for fine in faces:
        cells = fine.reshape(-1, n * n, fine.shape[1])  # by control face
        for run, start, end in sides(fine.shape[1], n):
            ends = np.stack([cells[:, run[0], start], cells[:, run[-1], end]], axis=1)
            chosen = cells[np.isin(pair_keys(ends), wanted)][:, run]
            found.append(chosen[:, :, [start, end]].reshape(-1, 2))
    return np.concatenate(found)


def edge_table(faces: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """(e, 2) int32: the edges of the core's (triangles (T, 3), quads (Q, 4)), and (corners,) int32:
    the edge that leaves each corner.
    """
    ends = [np.stack([fine, np.roll(fine, -1, axis=1)], axis=2).reshape(-1, 2) for fine in faces]
    keys, corner_edges = np.unique(pair_keys(np.concatenate(ends)), return_inverse=True)
    edges = np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1).astype(np.int32)
    return edges, corner_edges.ravel().astype(np.int32)


def mark_pairs(edges: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """(e,) bool: which of the `edges` (e, 2) are among the vertex `pairs` (k, 2), whichever way
    round.
    """
    return np.isin(pair_keys(edges), pair_keys(pairs))


def sides(corners: int, n: int) -> tuple[Side, ...]:
    """For each side of a face with 3 or 4 corners: its n cells in order, and which two of their
    corners lie on it.
    """
    return _triangle_sides(n) if corners == 3 else _quad_sides(n)


def pair_keys(pairs: np.ndarray) -> np.ndarray:
    """One number for each vertex pair, whichever way round it is given: (…, 2) integers → (k,)
    int64.
    """
    pairs = np.sort(pairs.astype(np.int64).reshape(-1, 2), axis=1)
    return pairs[:, 0] << 32 | pairs[:, 1]


def _triangle_sides(n: int) -> tuple[Side, ...]:
    left = np.arange(n)
    row = n * n - (n - left) ** 2  # the first cell of each row
    return (
        (2 * left, 0, 1),
        (row + 2 * (n - left - 1), 1, 2),
        (row[::-1], 2, 0),
    )


def _quad_sides(n: int) -> tuple[Side, ...]:
    run = np.arange(n)
    return (
        (run, 0, 1),
        (run * n + n - 1, 1, 2),
        (n * (n - 1) + run[::-1], 2, 3),
        (run[::-1] * n, 3, 0),
    )


@dataclass(frozen=True)
class Cells:
    """The P points and n² cells of a control face with k corners."""

    points: np.ndarray  # (P, 2) int32: i, j
    corner_point: np.ndarray  # (n² k,) int32: the point at each corner of each cell
    first_corner: np.ndarray  # (P,) int32: a corner that lies at each point
    weights: np.ndarray  # (P, k) float64, whole numbers: how much each corner of the face counts
    total: float  # what the weights of a point add up to, a power of two

    @property
    def apex(self) -> int:
        """The point at the last corner."""
        return int(np.argmax(self.weights[:, -1]))


def make_cells(corners: int, levels: int) -> Cells:
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


def _quad(n: int) -> tuple[np.ndarray, np.ndarray]:
    at = np.arange((n + 1) ** 2, dtype=np.int32).reshape(n + 1, n + 1)  # by row j and step i
    j, i = np.divmod(np.arange((n + 1) ** 2, dtype=np.int32), n + 1)
    corners = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2)
    return np.stack([i, j], axis=1), corners.ravel()


def _triangle(n: int) -> tuple[np.ndarray, np.ndarray]:
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
