# SPDX-License-Identifier: GPL-3.0-or-later
"""Border edges with a boundary of their own are marked in Edit Mode, read, shown and carried on."""

import bpy
import numpy as np
import pytest
from scenes import add_sheet, edit, faces_at_edges, fair, positions, to_object_mode

from addon.mesh.marks import BOUNDARY
from addon.mesh.read import control_mesh, read_mesh
from addon.transfer.cut_out import cut_out

SIDE = 3  # faces; vertex (i, j) is number 4 i + j
BOTTOM = [(0, 1), (1, 2), (2, 3)]


def sheet(name="Sheet"):
    return add_sheet(name, range(4), range(4), lambda i, j: 0.4 * np.sin(1.7 * i + j))


def edges(target, *pairs):
    """Numbers of the edges that join these vertices."""
    wanted = {frozenset(pair) for pair in pairs}
    return [e.index for e in target.data.edges if frozenset(e.vertices) in wanted]


def mark(target, boundary, *pairs):
    edit(target, "EDGE", edges(target, *pairs))
    answer = bpy.ops.object.fairing_boundary(boundary=boundary)
    to_object_mode()
    return answer


def marks(target):
    """{pair: number} of the edges that have one."""
    layer = target.data.attributes.get(BOUNDARY.name)
    if layer is None:
        return {}
    pairs = (tuple(sorted(edge.vertices)) for edge in target.data.edges)
    return {pair: item.value for pair, item in zip(pairs, layer.data) if item.value}


def straight(target, source, a, b):
    """The number of border points of the surface on the straight line between two vertices."""
    start, end = positions(source.data)[[a, b]].astype(float)
    way = end - start
    faces = faces_at_edges(target.data)
    ids = {v for e in target.data.edges if faces[e.index] == 1 for v in e.vertices}
    points = positions(target.data)[sorted(ids)].astype(float) - start
    share = points @ way / (way @ way)
    off = np.linalg.norm(points - share[:, None] * way, axis=1)
    return int(((share > 0.01) & (share < 0.99) & (off < 1e-6)).sum())


def test_only_selected_border_edges_are_marked():
    source = sheet()
    assert mark(source, "LINEAR", *BOTTOM[:2], (5, 6)) == {"FINISHED"}
    assert marks(source) == {(0, 1): 2, (1, 2): 2}
    assert mark(source, "FREE", (1, 2)) == {"FINISHED"}
    assert marks(source) == {(0, 1): 2, (1, 2): 3}
    assert mark(source, "SURFACE", (0, 1), (1, 2)) == {"FINISHED"}
    assert marks(source) == {}


def test_without_a_border_edge_nothing_is_marked():
    source = sheet()
    with pytest.raises(RuntimeError, match="Select edges at an open border"):
        mark(source, "FREE", (5, 6))
    assert bpy.ops.object.fairing_boundary.poll()
    to_object_mode()
    assert BOUNDARY.name not in source.data.attributes
    assert not bpy.ops.object.fairing_boundary.poll()


def test_marked_edges_are_selected_again():
    source = sheet()
    mark(source, "LINEAR", *BOTTOM[:2])
    mark(source, "FREE", (12, 13))
    edit(source, "EDGE")
    assert bpy.ops.object.fairing_select_boundary(boundary="LINEAR") == {"FINISHED"}
    to_object_mode()
    assert [e.index for e in source.data.edges if e.select] == edges(source, *BOTTOM[:2])


def test_the_surface_has_straight_edges_where_they_are_marked():
    source = sheet()
    mark(source, "LINEAR", *BOTTOM[:2])
    surface = fair(levels=3, boundary="CURVE")
    assert [straight(surface, source, a, b) for a, b in BOTTOM] == [7, 7, 0]
    assert BOUNDARY.name not in surface.data.attributes
    plain = sheet("Plain")
    assert straight(fair(levels=3, boundary="CURVE"), plain, *BOTTOM[0]) == 0


def test_a_cut_lays_no_mark_bare():
    source = sheet()
    mark(source, "LINEAR", *BOTTOM)
    with control_mesh(bpy.context, source) as mesh:
        arrays = read_mesh(mesh)
    inner = [k for k, e in enumerate(arrays.edges.tolist()) if sorted(e) == [1, 5]]
    arrays.boundary_edge[inner] = 3
    part = cut_out(arrays, np.arange(9) % SIDE == 0).arrays
    assert {key: len(pairs) for key, pairs in part.boundary_edges().items()} == {"linear": 1}
