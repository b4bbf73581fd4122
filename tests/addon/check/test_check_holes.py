# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Mesh lists holes, shows one and fills one."""

import bmesh
import bpy
import pytest
from fake_layout import draw
from hole_scenes import ball, borders, is_closed, without
from scenes import refused, to_object_mode

from addon.check.defects import recall_defects, recall_holes
from addon.ui import inspect as check_panel


def checked(target):
    assert bpy.ops.object.fairing_check() == {"FINISHED"}
    assert recall_defects(target) == ([], False)
    return recall_holes(target)


def two_holes():
    return without(ball(), lambda c: c[2] > 0.7 or c[2] < -0.9)


def test_holes_are_listed_the_largest_first():
    target = two_holes()
    holes = checked(target)
    assert len(holes) == 2 and holes[0]["width"] > 1.4 > 1.0 > holes[1]["width"]
    assert sum(hole["edges"] for hole in holes) == len(borders(target))
    for hole in holes:
        assert {frozenset(hole["at"])} <= {frozenset(e.vertices) for e in target.data.edges}
    drawn = draw(check_panel.VIEW3D_PT_fairing_check)
    assert f"{holes[0]['width']:.3g} m wide, {holes[0]['edges']} edges" in drawn
    assert drawn.count("object.fairing_fill") == drawn.count("object.fairing_select_hole") == 2


def test_one_is_shown():
    target = two_holes()
    hole = checked(target)[0]
    assert bpy.ops.object.fairing_select_hole(edge=hole["at"]) == {"FINISHED"}
    assert target.mode == "EDIT"
    chosen = [e for e in bmesh.from_edit_mesh(target.data).edges if e.select]
    assert len(chosen) == hole["edges"] and all(e.is_boundary for e in chosen)
    assert recall_defects(target) == ([], False)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_one_is_filled_and_the_list_goes_on(mode):
    target = two_holes()
    large, small = checked(target)
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.object.fairing_fill(edge=small["at"]) == {"FINISHED"}
    assert recall_defects(target) == ([], False)
    assert recall_holes(target) == [large]
    assert bpy.ops.object.fairing_fill(edge=large["at"]) == {"FINISHED"}
    to_object_mode()
    assert is_closed(target.data) and recall_holes(target) == []


def test_a_hole_that_is_gone_is_said():
    target = two_holes()
    hole = checked(target)[0]
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    refused("no longer there", bpy.ops.object.fairing_fill, edge=hole["at"])
    assert bpy.ops.object.fairing_select_hole(edge=hole["at"]) == {"FINISHED"}
    assert target.mode == "OBJECT"
