# SPDX-License-Identifier: GPL-3.0-or-later
"""Creases and corners from plain arrays; nothing here needs Blender."""

import numpy as np
import pytest

from addon.read.mesh import ControlArrays
from addon.request.features import corner_vertices, crease_edges


def triangle(**attributes):
    """One triangle 0 1 2 and a loose edge 2 3."""
    nothing = dict.fromkeys(("edge_crease", "vertex_crease", "sharp_edge"))
    return ControlArrays(
        positions=np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 2, 0)], float),
        edges=np.array([(0, 1), (1, 2), (0, 2), (2, 3)], np.int32),
        corners=np.array([0, 1, 2], np.int32),
        corner_edges=np.array([0, 1, 2], np.int32),
        offsets=np.array([0, 3], np.int32),
        **{**nothing, **attributes},
    )


def test_nothing_without_attributes():
    assert crease_edges(triangle(), 0.0, True).shape == (0, 2)
    assert corner_vertices(triangle(), 0.0).shape == (0,)


@pytest.mark.parametrize(
    "threshold, expected", [(0.0, [(0, 1), (1, 2)]), (0.5, [(0, 1), (1, 2)]), (0.6, [(0, 1)]), (None, [])]
)
def test_crease_threshold(threshold, expected):
    weights = np.array([1.0, 0.5, 0.0, 1.0], np.float32)
    assert [tuple(e) for e in crease_edges(triangle(edge_crease=weights), threshold)] == expected


def test_threshold_compares_in_the_precision_of_the_attribute():
    weights = np.full(4, 0.1, np.float32)
    assert len(crease_edges(triangle(edge_crease=weights), 0.1)) == 3


def test_sharp_edges_add_to_creases():
    arrays = triangle(
        edge_crease=np.array([1, 0, 0, 0], np.float32), sharp_edge=np.array([True, False, True, True])
    )
    assert [tuple(e) for e in crease_edges(arrays, 0.5, use_sharp=True)] == [(0, 1), (0, 2)]
    assert [tuple(e) for e in crease_edges(arrays, 0.5, use_sharp=False)] == [(0, 1)]
    assert [tuple(e) for e in crease_edges(arrays, None, use_sharp=True)] == [(0, 1), (0, 2)]


def test_corners_from_vertex_creases():
    weights = np.array([1.0, 0.2, 0.0, 1.0], np.float32)
    assert corner_vertices(triangle(vertex_crease=weights), 0.5).tolist() == [0]
    assert corner_vertices(triangle(vertex_crease=weights), None).tolist() == []
