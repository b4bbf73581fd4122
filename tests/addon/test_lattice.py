# SPDX-License-Identifier: GPL-3.0-or-later
"""Control edges found again in the refined faces, on one triangle and one quad written as the core writes them."""

import numpy as np
import pytest

from addon.carry.lattice import fine_edges, mark_pairs

# two levels of a triangle: rows of 4, 3, 2, 1 upward cells, vertices numbered row by row
TRIANGLE_ROWS = ((0, 1, 2, 3, 4), (5, 6, 7, 8), (9, 10, 11), (12, 13), (14,))


def triangle_cells():
    cells = []
    for low, high in zip(TRIANGLE_ROWS, TRIANGLE_ROWS[1:], strict=False):
        for i in range(len(high)):
            cells.append((low[i], low[i + 1], high[i]))
            if i + 1 < len(high):
                cells.append((low[i + 1], high[i + 1], high[i]))
    return np.array(cells, np.int32)


def quad_cells():
    ids = np.arange(25).reshape(5, 5)
    corners = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    return np.stack([c.ravel() for c in corners], axis=1).astype(np.int32)


NO_TRIANGLES, NO_QUADS = np.empty((0, 3), np.int32), np.empty((0, 4), np.int32)


@pytest.mark.parametrize(
    "pair, run", [((0, 4), [0, 1, 2, 3, 4]), ((4, 14), [4, 8, 11, 13, 14]), ((14, 0), [14, 12, 9, 5, 0])]
)
def test_triangle_sides(pair, run):
    expected = list(zip(run, run[1:], strict=False))
    for given in (pair, pair[::-1]):
        assert [tuple(e) for e in fine_edges((triangle_cells(), NO_QUADS), [given], 2)] == expected


@pytest.mark.parametrize(
    "pair, run",
    [
        ((0, 4), range(5)),
        ((4, 24), range(4, 25, 5)),
        ((24, 20), range(24, 19, -1)),
        ((20, 0), range(20, -1, -5)),
    ],
)
def test_quad_sides(pair, run):
    expected = list(zip(run, run[1:], strict=False))
    assert [tuple(e) for e in fine_edges((NO_TRIANGLES, quad_cells()), [pair], 2)] == expected


def test_no_edge_asked_for():
    assert fine_edges((triangle_cells(), quad_cells()), np.empty((0, 2), np.int32), 2).shape == (0, 2)


def test_mark_pairs():
    edges = np.array([(0, 1), (1, 2), (2, 0)], np.int32)
    assert mark_pairs(edges, np.array([(1, 0), (0, 2)])).tolist() == [True, False, True]
