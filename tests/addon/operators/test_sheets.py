# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets that meet become one mesh, which gets the data of the control mesh."""

from live_scenes import through
from scenes import add, faces_at_edges, fair

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
