# SPDX-License-Identifier: GPL-3.0-or-later
"""How much a refined surface changes from one level to the next."""

from __future__ import annotations

from math import inf

import numpy as np

from .lattice import Lattice
from .result import Result

CELLS_AT_ONCE = 1 << 14  # at which two surfaces are compared; at least one control face


def change_between(coarse: Result, fine: Result, levels: int, finer: int = 1) -> np.ndarray:
    """(F,) float64: for each control face, the largest distance, along normals, between the surfaces of
    `levels` and of `finer` levels less, at common points; mesh units. Computed in blocks of control faces.
    """
    cells, n = 4**levels, 2**levels
    found = np.zeros(sum(map(len, fine.faces)) // cells)
    begin = 0  # of the triangles, then of the quads
    for corners, few, many in zip((3, 4), coarse.faces, fine.faces):
        few, many = few.reshape(-1, cells >> 2 * finer, corners), many.reshape(-1, cells, corners)
        own = found[begin : begin + len(few)]
        begin += len(few)
        if not len(few):
            continue
        shared = (_cells(n >> finer, corners == 4, 1), _cells(n, corners == 4, 1 << finer))
        at_once = max(1, CELLS_AT_ONCE // cells)
        for first in range(0, len(few), at_once):
            part = slice(first, first + at_once)
            points = coarse.vertices[few[part, shared[0], 0]]
            own[part] = _distances(points, fine.vertices, many[part, shared[1]]).max(axis=1)
    return found


def _distances(points: np.ndarray, vertices: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Distance of each point from the plane at its cell's first corner."""
    a, b, c = (vertices[cells[:, :, k]] for k in (0, 1, -1))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=2)
    gap = np.einsum("fck,fck->fc", a - points, normal)
    return np.abs(gap) / np.where(length > 0, length, inf)


def _cells(n: int, quad: bool, every: int) -> np.ndarray:
    """The cells of a face that start at every such column and row; in a triangle those that point up."""
    lattice = Lattice(n, quad)
    first, second = lattice.cells[:, :2].T
    i, j = lattice.i[first], lattice.j[first]
    points_up = lattice.j[second] == j
    return np.flatnonzero(points_up & (i % every == 0) & (j % every == 0))
