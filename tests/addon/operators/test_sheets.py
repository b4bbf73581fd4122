# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets that meet become one mesh, which gets the data of the control mesh."""

import numpy as np
from live_scenes import through
from refined import control_arrays, core_run
from scenes import add, faces_at_edges, fair, positions, weights

from addon.transfer.mirror import find_mirrors

# Three pages, two faces each, at the spine 0 1 2; the first two are each other's mirror image
# across x = 0.
SPINE = [(0, 0, 0), (0, 0.3, 1), (0, 0, 2)]
PAGES = [[(s * 1, 1, z) for z in (0, 1, 2)] for s in (1, -1)] + [[(0, -1, z) for z in (0, 1, 2)]]
POINTS = SPINE + [point for page in PAGES for point in page]
FACES = [  # their first side is the spine
    [k, k + 1, first + k + 1, first + k] if turned else [k + 1, k, first + k, first + k + 1]
    for first, turned in ((3, False), (6, True), (9, False))
    for k in (0, 1)
]


def book():
    return add("Book", POINTS, FACES)


def test_one_mesh_whose_pages_share_the_spine():
    source = book()
    target = fair(levels=2)
    counts = faces_at_edges(target.data)
    assert counts.count(3) == 2 * 4 and max(counts) == 3 and min(counts) == 1
    assert not target.data.validate()
    assert through(target, source)
    spine = [e for e in target.data.edges if e.use_edge_sharp]
    assert len(spine) == 2 * 4, "a curve, and sharp like all"


def test_uv_maps_groups_and_shape_keys_come_along():
    source = book()
    uv = source.data.uv_layers.new(name="Pages").uv
    for k, loop in enumerate(source.data.loops):  # each page has a column of its own
        page, along = k // 8, source.data.vertices[loop.vertex_index].co.z
        uv[k].vector = (page + 0.5 * (loop.vertex_index < 3), along)
    source.vertex_groups.new(name="Spine").add([0, 1, 2], 1.0, "REPLACE")
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Bent").data[4].co.x += 0.5
    target = fair(levels=2)
    bent, own = (o.data.shape_keys.key_blocks["Bent"].data for o in (target, source))
    assert len(bent) == len(target.data.vertices) and np.isclose(bent[4].co.x, own[4].co.x)
    made = target.data.uv_layers["Pages"].uv
    for polygon in target.data.polygons:
        page = polygon.index // (2 * 16)
        columns = [made[k].vector.x for k in polygon.loop_indices]
        assert page <= min(columns) and max(columns) <= page + 0.5
    spine = weights(target, "Spine")
    assert {spine[v] for e in target.data.edges if e.use_edge_sharp for v in e.vertices} == {1.0}
    assert np.isnan(spine[3:12]).any()


def test_a_wall_in_the_plane_of_symmetry():
    mirrors, notes = mirrors_of(FACES)  # the third page lies in x = 0
    assert [mirror.axis for mirror in mirrors] == [0] and not notes
    bent = [(*point[:2], point[2] + 0.2 * point[1]) for point in POINTS]
    source = add("Book", bent, FACES)
    x = positions(fair(levels=3).data)[:, 0]
    assert np.array_equal(np.sort(x), np.sort(-x)) and (x == 0).sum() == 9 * 17
    assert source.data.polygons[4].normal.x != 0


def mirrors_of(faces):
    arrays = control_arrays(POINTS, faces)
    return find_mirrors(core_run(arrays, 2)[1], arrays)
