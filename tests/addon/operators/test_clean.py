# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean Scan closes a spoiled ball, and the mesh keeps its data."""

import bmesh
import bpy
import numpy as np
from fake_layout import draw
from hole_scenes import ball, is_closed, radii, without
from scenes import bmesh_of, positions, to_object_mode

from addon.check.defects import recall_cleaned, recall_defects
from addon.ui.check import VIEW3D_PT_fairing_check


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


def seams_at(mesh):
    """The places of the creased seams."""
    creases = mesh.attributes["crease_edge"].data
    seams = [e for e in mesh.edges if e.use_seam and creases[e.index].value == 0.75]
    return {
        tuple(sorted(tuple(np.round(mesh.vertices[v].co, 5)) for v in e.vertices)) for e in seams
    }


def test_what_lies_on_the_mesh_stays():
    target = spoiled()
    mesh = target.data
    mesh.materials.append(bpy.data.materials.new("A"))
    mesh.materials.append(bpy.data.materials.new("B"))
    for face in mesh.polygons:
        face.material_index = int(face.center[0] > 0.0)
    group = target.vertex_groups.new(name="Left")
    group.add([v.index for v in mesh.vertices if v.co[0] < 0.0], 0.5, "REPLACE")
    uv = mesh.uv_layers.new(name="Map")
    for loop in mesh.loops:
        uv.data[loop.index].uv = mesh.vertices[loop.vertex_index].co[:2]
    seams = mesh.attributes.new("crease_edge", "FLOAT", "EDGE")
    for edge in mesh.edges:
        ends = [mesh.vertices[v].co for v in edge.vertices]
        if edge.index % 7 == 0 and all(abs(co[2]) < 0.6 and co.length < 1.01 for co in ends):
            edge.use_seam, seams.data[edge.index].value = True, 0.75
    target.shape_key_add(name="Basis")
    key = target.shape_key_add(name="Wide")
    for point in key.data:
        point.co.x += 0.25
    creased = seams_at(mesh)
    assert bpy.ops.object.fairing_clean() == {"FINISHED"}
    assert is_closed(mesh)
    basis = positions(mesh)
    wide = np.empty(3 * len(basis))
    mesh.shape_keys.key_blocks["Wide"].data.foreach_get("co", wide)
    old = basis[:, 2] < 0.85
    assert np.allclose((wide.reshape(-1, 3) - basis)[old], [0.25, 0.0, 0.0], atol=1e-5)
    for face in mesh.polygons:
        if face.center[2] < 0.85:
            assert face.material_index == int(face.center[0] > 0.0)
    uv = mesh.uv_layers["Map"]
    for loop in mesh.loops:
        co = mesh.vertices[loop.vertex_index].co
        if -0.9 < co[2] < 0.85:
            assert np.allclose(uv.data[loop.index].uv, co[:2], atol=1e-5)
    for vertex in mesh.vertices:
        if -0.9 < vertex.co[2] < 0.85:
            assert bool(vertex.groups) == (vertex.co[0] < 0.0)
    assert seams_at(mesh) == creased and len(creased) > 50


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


def test_in_edit_mode():
    target = spoiled()
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.object.fairing_clean() == {"FINISHED"}
    to_object_mode()
    assert is_closed(target.data)
