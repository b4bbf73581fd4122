# SPDX-License-Identifier: GPL-3.0-or-later
"""Clean Scan in a window: a list of what was done, one step of undo."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import bmesh
import bpy
import harness
import numpy as np


def scan():
    """A ball of 5,120 triangles with a hole, a spike, a fin, faces turned over and a speck beside it."""
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1.0)
        target = bpy.context.object
        bm = bmesh.new()
        bm.from_mesh(target.data)
        high = [f for f in bm.faces if f.calc_center_median().z > 0.85]
        bmesh.ops.delete(bm, geom=high, context="FACES")
        bmesh.ops.reverse_faces(bm, faces=[f for f in bm.faces if f.calc_center_median().x > 0.9])
        bm.verts.ensure_lookup_table()
        min(bm.verts, key=lambda v: v.co.z).co *= 1.4
        edge = min((e for e in bm.edges if e.is_manifold), key=lambda e: e.verts[0].co.y)
        bm.faces.new([*edge.verts, bm.verts.new(edge.verts[0].co * 1.3)])
        bm.faces.new(
            [bm.verts.new((1.5, 0.0, z)) for z in (0.0, 0.1)] + [bm.verts.new((1.6, 0, 0))]
        )
        bm.to_mesh(target.data)
        bm.free()
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.6, type="ORBITUP")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="the scan is there")
    yield 0.5
    return target


def border_edges(target):
    bm = bmesh.new()
    bm.from_mesh(target.data)
    count = sum(not edge.is_manifold for edge in bm.edges)
    bm.free()
    return count


def test_a_scan_is_closed_and_undo_brings_it_back():
    target = yield from scan()
    before = len(target.data.polygons)
    yield from harness.unfold_panels("VIEW3D_PT_fairing_inspect", "VIEW3D_PT_fairing_check")
    harness.call(bpy.ops.object.fairing_clean, "INVOKE_DEFAULT", True)
    yield from harness.until_it_ends()
    target = bpy.context.object
    said = harness.module("check.defects").recall_cleaned(target)
    assert said[-1].startswith("Watertight: yes; volume 4.1"), said
    assert "m³; left: nothing" in said[-1], said
    assert border_edges(target) == 0
    radii = [v.co.length for v in target.data.vertices]
    assert np.abs(np.array(radii) - 1.0).max() < 0.02
    yield from harness.show_the_end_of_the_sidebar()
    harness.photograph("clean_done")
    harness.undo()
    yield 0.5
    assert len(bpy.context.object.data.polygons) == before


harness.run_in_window(globals())
