# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders keep their corners by default: the vertices of a single face where they turn sharply."""

import numpy as np
from scenes import add, fair, positions


def tent(top=0.8):
    """Two by two quads, drawn up in the middle."""
    points = [(x, y, top * (x == 0 and y == 0)) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    faces = [(a, a + 1, a + 4, a + 3) for a in (0, 1, 3, 4)]
    return add("Tent", points, faces)


def farthest_from_square(mesh):
    """Of the border's vertices, which have fewer than four edges."""
    uses = np.bincount(np.array([edge.vertices[:] for edge in mesh.edges]).ravel())
    border = positions(mesh)[uses < 4]
    return np.abs(np.abs(border[:, :2]).max(axis=1) - 1).max()


def test_the_border_of_a_square_sheet_stays_square():
    tent()
    assert farthest_from_square(fair(levels=3).data) < 1e-6


def test_a_smooth_border_rounds_them():
    tent()
    assert farthest_from_square(fair(levels=3, boundary="CURVE").data) > 0.05
