# SPDX-License-Identifier: GPL-3.0-or-later
"""Ease Selected: in Edit Mode vertices go where the surface through all others wants them."""

import bmesh
import bpy
import numpy as np
import pytest
from dunes import OFF, WRONG, add_dune, dune
from scenes import CUBE, add, computed, edit, refused

from addon.strain.measure import StrainJob

EDGE = 3  # on the open border


def places(source):
    edited = bmesh.from_edit_mesh(source.data)
    return np.array([tuple(v.co) for v in edited.verts])


def ways(source):
    return computed(StrainJob(bpy.context, source)).result.directions


def test_the_wrong_one_goes_back_as_far_as_it_strains_and_no_other_moves():
    source = add_dune()
    edit(source, "VERT", [WRONG])
    before, way = places(source), ways(source)[WRONG]
    assert bpy.ops.object.fairing_ease_selected() == {"FINISHED"}
    moved = places(source) - before
    # the strain of a gross error is measured again without it, the move is not
    assert moved[WRONG] == pytest.approx(way, rel=0.02, abs=0.02 * OFF)
    assert moved[WRONG, 2] == pytest.approx(-OFF, rel=0.15)
    assert not np.delete(moved, WRONG, axis=0).any(), "to the bit"
    left = np.abs(ways(source)[WRONG]).max()
    assert left < 0.02 * OFF, "it hardly strains: its neighbourhood is another now"


def test_several_together_and_part_of_the_way():
    source = add_dune(wrong=(24, WRONG))
    edit(source, "VERT", (24, WRONG))
    before = places(source)
    bpy.ops.object.fairing_ease_selected(factor=0.5)
    half = places(source) - before
    edit_undone = dune(wrong=(24, WRONG))
    edited = bmesh.from_edit_mesh(source.data)
    for vertex, place in zip(edited.verts, edit_undone, strict=True):
        vertex.co = place
    bmesh.update_edit_mesh(source.data)
    bpy.ops.object.fairing_ease_selected()
    whole = places(source) - before
    assert np.allclose(half, 0.5 * whole, atol=1e-5)
    assert whole[[24, WRONG], 2] == pytest.approx([-OFF, -OFF], rel=0.25)


def test_vertices_on_borders_stay():
    source = add_dune()
    assert not bpy.ops.object.fairing_ease_selected.poll()
    edit(source, "VERT", (EDGE, WRONG))
    before = places(source)
    bpy.ops.object.fairing_ease_selected()
    moved = places(source) - before
    assert moved[WRONG].any() and not moved[EDGE].any()
    edit(source, "VERT", [EDGE])
    refused("Select vertices inside of the mesh", bpy.ops.object.fairing_ease_selected)


def test_something_must_hold_the_surface():
    box = add("Box", *CUBE)
    edit(box, "VERT", range(8))
    refused("nothing holds it", bpy.ops.object.fairing_ease_selected)
    edit(box, "VERT", range(7))
    assert bpy.ops.object.fairing_ease_selected() == {"FINISHED"}
