# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scenes import CUBE, add, set_edge_attribute

from addon.mesh.read import read_mesh


def test_faces_and_edges():
    arrays = read_mesh(add("Box", *CUBE).data)
    assert np.array_equal(arrays.positions, np.array(CUBE[0], float))
    faces = [tuple(arrays.corners[a:b]) for a, b in zip(arrays.offsets, arrays.offsets[1:])]
    assert faces == CUBE[1]
    leaving = arrays.edges[arrays.corner_edges]
    assert all(vertex in edge for vertex, edge in zip(arrays.corners, leaving))


def test_empty_mesh():
    arrays = read_mesh(add("Nothing", [], []).data)
    assert arrays.positions.shape == (0, 3) and arrays.edges.shape == (0, 2)
    assert arrays.corners.shape == (0,) and arrays.offsets.tolist() == [0]


def test_creases():
    mesh = add("Box", *CUBE).data
    set_edge_attribute(mesh, "crease_edge", "FLOAT", [(0, 1)], 0.75)
    arrays = read_mesh(mesh)
    assert [tuple(sorted(e)) for e in arrays.edges[arrays.edge_crease == 0.75]] == [(0, 1)]


@pytest.mark.parametrize(
    "domain, data_type", [("FACE", "FLOAT"), ("EDGE", "INT"), ("POINT", "FLOAT")]
)
def test_a_stranger_by_the_same_name_is_ignored(domain, data_type):
    mesh = add("Box", *CUBE).data
    mesh.attributes.new("crease_edge", data_type, domain)
    assert read_mesh(mesh).edge_crease is None
