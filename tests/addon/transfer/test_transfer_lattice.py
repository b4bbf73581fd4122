# SPDX-License-Identifier: GPL-3.0-or-later
"""The lattice of a refined face and the control edges in it, against faces by hand."""

import discrete_fairing as df
import numpy as np
import pytest
from lattices import lattice_faces

from addon.mesh.write import write_mesh
from addon.transfer.lattice import edge_table

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
    return lattice_faces(5, 5)[:, [0, 3, 2, 1]].astype(np.int32)


@pytest.mark.parametrize("levels", [0, 2])
def test_the_edges_of_a_surface_are_those_that_blender_finds(levels):
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0.5, 0), (0, 0, 1)]
    found = df.fair(points, [(0, 1, 2, 3), (1, 4, 2), (0, 5, 1)], levels)
    nothing = np.empty((0, 2), np.int32)
    theirs = write_mesh("Theirs", found, nothing)
    ours = write_mesh("Ours", found, nothing, (), edge_table(found.faces))
    assert not ours.validate(), "nothing to be mended"
    pairs = [{frozenset(edge.vertices) for edge in mesh.edges} for mesh in (ours, theirs)]
    assert pairs[0] == pairs[1] and len(ours.edges) == len(theirs.edges)
    for loop, following in ((a, b) for p in ours.polygons for a, b in cycle(p, ours)):
        ends = set(ours.edges[loop.edge_index].vertices)
        assert ends == {loop.vertex_index, following.vertex_index}


def cycle(polygon, mesh):
    loops = [mesh.loops[i] for i in polygon.loop_indices]
    return zip(loops, loops[1:] + loops[:1])
