# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean Scan closes a spoiled ball, and the mesh keeps its data."""

import bmesh
import bpy
import numpy as np
from fake_layout import draw
from hole_scenes import ball, is_closed, radii, without
from scenes import bmesh_of, to_object_mode

from addon.check.defects import recall_cleaned, recall_defects
from addon.ui.inspect import VIEW3D_PT_fairing_check


def spoiled():
    """A ball with a hole, a spike, faces turned over, a fin and a speck."""
    target = without(ball(), lambda c: c.z > 0.9)
    with bmesh_of(target.data) as bm:
        bmesh.ops.reverse_faces(bm, faces=[f for f in bm.faces if f.calc_center_median().x > 0.8])
        min(bm.verts, key=lambda v: v.co.z).co *= 1.7
        edge = min((e for e in bm.edges if e.is_manifold), key=lambda e: e.verts[0].co.y)
        bm.faces.new([*edge.verts, bm.verts.new(edge.verts[0].co * 1.3)])
        bm.faces.new([bm.verts.new(co) for co in ((3, 3, 0), (3, 3, 0.1), (3.1, 3, 0))])
    return target


def test_a_spoiled_ball_is_closed():
    target = spoiled()
    assert bpy.ops.object.fairing_clean() == {"FINISHED"}
    assert is_closed(target.data)
    assert np.abs(radii(target) - 1).max() < 0.02
    said = recall_cleaned(target)
    assert said[-1].startswith("Watertight: yes") and said[-1].endswith("left: nothing")
    assert any("spike" in s for s in said) and any("fin" in s for s in said)
    assert any("hole" in s for s in said) and any("island" in s for s in said)
    assert recall_defects(target) == ([], False)
    assert not target.data.validate()


def test_faces_that_cross_are_listed_with_a_button_that_selects_them():
    """Two balls, one through the other: both are closed, and stay."""
    target = ball()
    with bmesh_of(target.data) as bm:
        for vertex in bmesh.ops.create_icosphere(bm, subdivisions=3, radius=1.0)["verts"]:
            vertex.co.x += 1.5
    assert bpy.ops.object.fairing_clean(inner=False) == {"FINISHED"}
    (defect,), stale = recall_defects(target)
    assert defect["code"] == "CROSSING_FACES" and not stale
    assert draw(VIEW3D_PT_fairing_check).count("object.fairing_select_defect") == 1
    assert bpy.ops.object.fairing_select_defect(index=0) == {"FINISHED"}
    chosen = [f for f in bmesh.from_edit_mesh(target.data).faces if f.select]
    assert len(chosen) == len(defect["elements"]) > 10
    # the circle in which two unit balls meet, 1.5 apart
    assert all(abs(f.calc_center_median().x - 0.75) < 0.2 for f in chosen)
    to_object_mode()
