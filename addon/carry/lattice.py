# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the control edges lie in a refined surface: plain arrays, no Blender.

The core writes the N² cells (N = 2^levels) of a control face one after another, row by row from the face's first side to
the opposite corner or side; in a triangle's row upward and downward cells alternate.
"""

import numpy as np


def fine_edges(faces, control_pairs, levels):
    """Vertex pairs (k, 2) of the refined edges that the control edges `control_pairs` (c, 2) were split into.

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


def mark_pairs(edges, pairs):
    """(e,) bool: which of the `edges` (e, 2) are among the vertex `pairs` (k, 2), whichever way round."""
    return np.isin(pair_keys(edges), pair_keys(pairs))


def sides(corners, n):
    """For each side of a face with 3 or 4 corners: its n cells in order, and which two of their corners lie on it."""
    return _triangle_sides(n) if corners == 3 else _quad_sides(n)


def pair_keys(pairs):
    """One number for each vertex pair, whichever way round it is given: (…, 2) integers → (k,) int64."""
    pairs = np.sort(pairs.astype(np.int64).reshape(-1, 2), axis=1)
    return pairs[:, 0] << 32 | pairs[:, 1]


def _triangle_sides(n):
    left = np.arange(n)
    row = n * n - (n - left) ** 2  # the first cell of each row
    return (
        (2 * left, 0, 1),
        (row + 2 * (n - left - 1), 1, 2),
        (row[::-1], 2, 0),
    )


def _quad_sides(n):
    run = np.arange(n)
    return (
        (run, 0, 1),
        (run * n + n - 1, 1, 2),
        (n * (n - 1) + run[::-1], 2, 3),
        (run[::-1] * n, 3, 0),
    )
