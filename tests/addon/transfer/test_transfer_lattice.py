# SPDX-License-Identifier: GPL-3.0-or-later
"""The lattice of a refined face and the control edges in it, against faces by hand."""

import bpy
import discrete_fairing as df
import numpy as np
import pytest

from addon.mesh.write import fill_mesh
from addon.transfer.seams import edge_table


@pytest.mark.parametrize("levels", [0, 2])
def test_the_edges_of_a_surface_are_those_that_blender_finds(levels):
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0.5, 0), (0, 0, 1)]
    found = df.fair(points, [(0, 1, 2, 3), (1, 4, 2), (0, 5, 1)], levels)
    nothing = np.empty((0, 2), np.int32)
    theirs, ours = (bpy.data.meshes.new(name) for name in ("Theirs", "Ours"))
    fill_mesh(theirs, found, nothing)
    fill_mesh(ours, found, nothing, edge_table(found.faces))
    assert not ours.validate(), "nothing to be mended"
    pairs = [{frozenset(edge.vertices) for edge in mesh.edges} for mesh in (ours, theirs)]
    assert pairs[0] == pairs[1] and len(ours.edges) == len(theirs.edges)
    for loop, following in ((a, b) for p in ours.polygons for a, b in cycle(p, ours)):
        ends = set(ours.edges[loop.edge_index].vertices)
        assert ends == {loop.vertex_index, following.vertex_index}


def cycle(polygon, mesh):
    loops = [mesh.loops[i] for i in polygon.loop_indices]
    return zip(loops, loops[1:] + loops[:1])
