# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Hole Fair in a window: from the list of Check, in Edit Mode, and over faces that are to go."""

import sys
from pathlib import Path
from time import perf_counter

sys.path.insert(0, str(Path(__file__).parent))

import bmesh
import bpy
import harness
import numpy as np

PATIENCE = 300.0  # seconds until a run must have ended


def ball_with_holes():
    """A unit sphere of 5,120 triangles, open above and, less wide, towards the viewer."""
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1.0)
        target = bpy.context.object
        edited = bmesh.new()
        edited.from_mesh(target.data)
        gone = []
        for face in edited.faces:
            x, y, z = face.calc_center_median()
            if z > 0.75 or (y < 0 and np.hypot(x + 0.2, z + 0.1) < 0.3):
                gone.append(face)
        bmesh.ops.delete(edited, geom=gone, context="FACES")
        edited.to_mesh(target.data)
        edited.free()
        bpy.ops.object.shade_smooth()
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.6, type="ORBITUP")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="the ball is there")
    yield 0.5
    return target


def open_edges(target):
    edited = bmesh.new()
    edited.from_mesh(target.data)
    count = sum(edge.is_boundary for edge in edited.edges)
    edited.free()
    return count


def largest_off(target):
    """How far the vertices are from the unit sphere."""
    return max(abs(vertex.co.length - 1.0) for vertex in target.data.vertices)


def call(operator, **options):
    with bpy.context.temp_override(**harness.view()):
        return getattr(bpy.ops.object, operator)(
            "INVOKE_DEFAULT", True, **options
        )  # True: a step of undo


def until_it_ends():
    begun = perf_counter()
    while harness.module("queue").running():
        assert perf_counter() - begun < PATIENCE, "the run does not end"
        yield 0.05
    yield 0.5


def test_check_lists_holes_and_fills_one():
    target = yield from ball_with_holes()
    yield from harness.unfold_panels("VIEW3D_PT_fairing_inspect", "VIEW3D_PT_fairing_check")
    assert call("fairing_check") == {"FINISHED"}
    for region in harness.view()["area"].regions:
        region.tag_redraw()
    yield 1.0
    harness.photograph("fill_listed")
    large, small = harness.module("check.defects").recall_holes(target)
    assert small["edges"] < large["edges"]
    call("fairing_fill", edge=small["at"])
    yield from until_it_ends()
    assert open_edges(target) == large["edges"]
    assert harness.module("check.defects").recall_holes(target) == [large]
    harness.photograph("fill_one_filled")
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.ed.undo()
    yield 0.5
    assert open_edges(bpy.context.object) == small["edges"] + large["edges"]


def test_all_holes_in_object_mode_in_one_step_of_undo():
    target = yield from ball_with_holes()
    before = open_edges(target)
    call("fairing_fill", largest=3.0)
    yield from until_it_ends()
    target = bpy.context.object
    assert open_edges(target) == 0 and largest_off(target) < 2e-3
    harness.photograph("fill_all_filled")
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.ed.undo()
    yield 0.5
    assert open_edges(bpy.context.object) == before


def test_a_dent_is_replaced_in_edit_mode():
    target = yield from ball_with_holes()
    for vertex in target.data.vertices:
        x, y, z = vertex.co
        if y < 0 and np.hypot(x - 0.35, z - 0.2) < 0.2:
            vertex.co *= 0.85
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="FACE")
        for face in bmesh.from_edit_mesh(target.data).faces:
            x, y, z = face.calc_center_median()
            face.select_set(bool(y < 0 and np.hypot(x - 0.35, z - 0.2) < 0.28))
        bmesh.update_edit_mesh(target.data)
    yield 0.5
    harness.photograph("fill_dent_selected")
    call("fairing_fill")
    yield from until_it_ends()
    harness.photograph("fill_dent_gone")
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.mode_set(mode="OBJECT")
    assert largest_off(bpy.context.object) < 2e-3


harness.run_in_window(globals())
