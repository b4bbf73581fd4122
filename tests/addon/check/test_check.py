# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Mesh finds, selects, describes and mends defects, with the core itself."""

import bmesh
import bpy
import pytest
from scenes import CUBE, add, to_object_mode

from addon.check.defects import recall_defects
from addon.jobs.clean import repair_label
from addon.mesh import mesh_changes

FAN = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)], [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
FLIPPED = (CUBE[0], [CUBE[1][0][::-1], *CUBE[1][1:]])
DOUBLED = ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3), (3, 2, 1, 0)])
LOOSE = ([*CUBE[0], (5, 5, 5)], CUBE[1])
SEAM = (
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0)],
    [(0, 1, 2, 3), (4, 5, 6, 7)],
)
FLAT_FACE = ([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])


def check():
    assert bpy.ops.object.fairing_check() == {"FINISHED"}
    return recall_defects(bpy.context.active_object)[0]


def codes(defects):
    return [defect["code"] for defect in defects]


def selected(target, kind):
    bm = bmesh.from_edit_mesh(target.data)
    return [e.index for e in getattr(bm, kind) if e.select]


def test_an_edge_with_three_faces_is_selected_in_edge_mode():
    fan = add("Fan", *FAN)
    assert codes(check()) == ["NONMANIFOLD_EDGE"]
    assert fan.mode == "EDIT"
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, True, False)
    (edge,) = [e for e in bmesh.from_edit_mesh(fan.data).edges if e.select]
    assert {v.index for v in edge.verts} == {0, 1}
    assert selected(fan, "faces") == []


def test_an_empty_mesh_leaves_edit_mode_off():
    empty = add("Empty", [], [])
    assert check() and empty.mode == "OBJECT"


def test_a_flipped_face_is_selected_and_turned_over_with_its_uvs():
    box = add("Box", *FLIPPED)
    box.data.uv_layers.new(name="UV")
    corner = {}
    for loop, uv in zip(box.data.loops, box.data.uv_layers["UV"].uv, strict=True):
        uv.vector = (loop.vertex_index * 0.1, loop.index * 0.01)
        corner[loop.vertex_index, loop.index // 4] = tuple(uv.vector)
    (defect,) = check()
    assert selected(box, "faces") == defect["elements"] == [0]
    bpy.ops.object.fairing_repair(index=0)
    assert recall_defects(box) == ([], False)
    to_object_mode()
    assert sorted(box.data.polygons[0].vertices) == sorted(CUBE[1][0])
    assert check() == []
    for polygon in box.data.polygons:
        for loop in polygon.loop_indices:
            uv = box.data.uv_layers["UV"].uv[loop].vector
            assert tuple(uv) == corner[box.data.loops[loop].vertex_index, polygon.index]


@pytest.mark.parametrize(
    "mesh, code",
    [
        (DOUBLED, "DUPLICATE_FACE"),
        (LOOSE, "ISOLATED_VERTICES"),
        (SEAM, "COINCIDENT_VERTICES"),
        (FLAT_FACE, "DEGENERATE_FACE"),
        (FLIPPED, "INCONSISTENT_ORIENTATION"),
    ],
)
@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_repairs_mend_what_they_promise(mesh, code, mode):
    target = add("Bad", *mesh)
    bpy.ops.object.mode_set(mode=mode)
    defects = check()
    assert code in codes(defects)
    assert repair_label(code)
    bpy.ops.object.fairing_repair(index=codes(defects).index(code))
    assert code not in codes(recall_defects(target)[0])
    to_object_mode()
    assert code not in codes(check())
    assert len(target.data.polygons) >= 1


def test_several_objects_only_the_bad_ones_are_opened():
    good, one, two = add("Good", *CUBE), add("One", *FAN), add("Two", *FLIPPED)
    for target in (good, one, two):
        target.select_set(True)
    check()
    assert [t.mode for t in (good, one, two)] == ["OBJECT", "EDIT", "EDIT"]
    assert codes(recall_defects(one)[0]) == ["NONMANIFOLD_EDGE"]
    assert recall_defects(good) == ([], False)
    assert selected(two, "faces") == [0]


def test_the_record_goes_stale_when_the_shape_changes():
    assert not bpy.ops.object.fairing_check.poll()
    box = add("Box", *CUBE)
    assert check() == [] and bpy.context.mode == "OBJECT"
    assert not recall_defects(box)[1]
    box.data.vertices[0].co.x += 1
    box.data.update()
    bpy.context.view_layer.update()
    assert recall_defects(box)[1]
    check()
    assert not recall_defects(box)[1]
    mesh_changes._forget()  # as after loading a file: the counts still tell
    box.data.vertices.add(1)
    assert recall_defects(box)[1]
