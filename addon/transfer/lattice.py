# SPDX-License-Identifier: GPL-3.0-or-later
"""The lattice of a refined control face: its points, cells and sides. Plain arrays, no Blender.

The core writes the N² cells (N = 2^levels) of a control face one after another, row by row from the
face's first side to the opposite corner or side; in a triangle's row upward and downward cells
alternate. A point (i, j) lies i steps along the face's first side and j steps along its last one.
"""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from .. import core

# the cells along a side of a face, and the two of their corners on it
Side: TypeAlias = tuple[np.ndarray, int, int]


def fine_edges(
    faces: tuple[np.ndarray, np.ndarray], control_pairs: np.ndarray, levels: int
) -> np.ndarray:
    """Vertex pairs (k, 2) of the refined edges into which the control edges `control_pairs` (c, 2) were
    split.

    `faces`: the core's (triangles (T, 3), quads (Q, 4)). An edge between two faces occurs twice.
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
    """(e, 2) int32 edges of the core's faces, and (corners,) the edge that leaves each corner."""
    ends = [np.stack([fine, np.roll(fine, -1, axis=1)], axis=2).reshape(-1, 2) for fine in faces]
    keys, corner_edges = np.unique(pair_keys(np.concatenate(ends)), return_inverse=True)
    edges = np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1).astype(np.int32)
    return edges, corner_edges.ravel().astype(np.int32)


def mark_pairs(edges: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """(e,) bool: which of the `edges` (e, 2) are among the vertex `pairs` (k, 2), in either direction."""
    return np.isin(pair_keys(edges), pair_keys(pairs))


def sides(corners: int, n: int) -> tuple[Side, ...]:
    """For each side of a face its n cells in order, and the two of their corners on it."""
    return _triangle_sides(n) if corners == 3 else _quad_sides(n)


def pair_keys(pairs: np.ndarray) -> np.ndarray:
    """One number for each vertex pair, in either direction: (…, 2) integers → (k,) int64."""
    pairs = np.sort(pairs.astype(np.int64).reshape(-1, 2), axis=1)
    return pairs[:, 0] << 32 | pairs[:, 1]


def _triangle_sides(n: int) -> tuple[Side, ...]:
    left = np.arange(n)
    row = n * n - (n - left) ** 2  # the first cell of each row
    return ((2 * left, 0, 1), (row + 2 * (n - left - 1), 1, 2), (row[::-1], 2, 0))


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

    lattice: Any  # the core's Lattice
    points: np.ndarray  # (P, 2) int32: i, j
    corner_point: np.ndarray  # (n² k,) int32: the point at each corner of each cell
    first_corner: np.ndarray  # (P,) int32: a corner that lies at each point
    weights: np.ndarray  # (P, k) float64: weight of each corner of the face


def make_cells(corners: int, levels: int) -> Cells:
    """Cells of a triangle (`corners` 3) or quad (4) that is refined `levels` times."""
    lattice = core.lattice(2**levels, corners == 4)
    points = np.stack([lattice.i, lattice.j], axis=1).astype(np.int32)
    corner_point = lattice.cells.ravel().astype(np.int32)
    first_corner = np.empty(len(points), np.int32)
    first_corner[corner_point[::-1]] = np.arange(len(corner_point), dtype=np.int32)[::-1]
    return Cells(lattice, points, corner_point, first_corner, lattice.weights())
