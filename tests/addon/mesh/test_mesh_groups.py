# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex groups: names, members and weights, and how an armature bends the result."""

import numpy as np
from refined import refine
from scenes import CUBE, add, weights


def test_weights_are_linear_and_control_vertices_keep_theirs():
    source = add("Cube", *CUBE)
    group = source.vertex_groups.new(name="Height")
    for vertex in source.data.vertices:
        group.add([vertex.index], 0.5 + 0.3 * vertex.co.z, "REPLACE")
    made = refine(source)
    expected = 0.5 + 0.3 * made.transfer.point(made.arrays.positions)[:, 2]
    found = weights(made.target, "Height")
    assert np.allclose(found, expected, atol=1e-6)
    assert np.array_equal(found[:8], weights(source, "Height"))


def test_groups_stay_sparse_and_keep_their_order():
    source = add("Cube", *CUBE)
    for name in ("Zero", "One", "None", "Part"):
        source.vertex_groups.new(name=name)
    source.vertex_groups["Zero"].add([0, 3], 0.0, "REPLACE")
    source.vertex_groups["One"].add(range(8), 1.0, "REPLACE")
    source.vertex_groups["Part"].add([0], 0.25, "REPLACE")
    source.vertex_groups["One"].lock_weight = True
    source.vertex_groups.active_index = 2
    target = refine(source, 1).target
    assert [g.name for g in target.vertex_groups] == ["Zero", "One", "None", "Part"]
    assert [g.lock_weight for g in target.vertex_groups] == [False, True, False, False]
    assert target.vertex_groups.active_index == 2
    assert np.flatnonzero(weights(target, "Zero") == 0).tolist() == [0, 3]
    assert (weights(target, "One") == 1).all()
    assert np.isnan(weights(target, "None")).all()
    # vertex 0, and the middles of its 3 edges and 3 faces
    assert np.isfinite(weights(target, "Part")).sum() == 7
    assert target.data.validate() is False
