# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat faces are found by shape, selected and cleared; only Bending keeps them flat."""

import bmesh
import bpy
import numpy as np
import pytest
from fake_layout import draw
from scenes import (
    add_rounded_box,
    add_suzanne,
    bmesh_of,
    edit,
    fair,
    positions,
    refused,
    set_edge_attribute,
    settings,
    to_object_mode,
)

from addon.jobs.fair import Job
from addon.mesh import marks
from addon.mesh.marks import FLAT
from addon.ui import main

RIM = 2.0


def box(size=(40.0, 30.0, 20.0), segments=2):
    return add_rounded_box(size, RIM, segments)


def shape(name):
    if name == "Suzanne":
        return add_suzanne()
    getattr(bpy.ops.mesh, f"primitive_{name}_add")()
    return bpy.context.object


def triangulate(source):
    edit(source, "FACE", range(len(source.data.polygons)))
    bpy.ops.mesh.quads_convert_to_tris()
    to_object_mode()


def marked(source):
    layer = source.data.attributes.get(FLAT.name)
    return [] if layer is None else [k for k, item in enumerate(layer.data) if item.value]


@pytest.mark.parametrize("segments", [1, 2, 4])
def test_the_flats_and_rims_of_a_rounded_box_are_found(segments):
    """Six flats and the strips between them, not the corners."""
    source = box(segments=segments)
    assert bpy.ops.object.fairing_flat_faces() == {"FINISHED"}
    found = marked(source)
    assert len(found) == marks.count([source], FLAT) == 6 + 12 * segments
    areas = [source.data.polygons[f].area for f in found]
    assert min(areas) > max(p.area for p in source.data.polygons if p.index not in found)
    triangulate(source)
    bpy.ops.object.fairing_flat_faces(clear=True)
    bpy.ops.object.fairing_flat_faces()
    assert sum(source.data.polygons[f].area for f in marked(source)) == pytest.approx(sum(areas))


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("name", ["Suzanne", "uv_sphere", "ico_sphere", "torus", "cube", "grid"])
def test_round_shapes_have_none(name, triangles):
    source = shape(name)
    if triangles:
        triangulate(source)
    assert bpy.ops.object.fairing_flat_faces() == {"FINISHED"}
    assert marked(source) == []


def test_the_angle_joins_faces_that_are_not_quite_in_a_plane():
    source = box()
    top = max(range(54), key=lambda f: source.data.polygons[f].center.z)
    edit(source, "FACE", [top])
    bpy.ops.mesh.poke()
    to_object_mode()
    source.data.vertices[-1].co.z += 0.02  # 1e-3 of half the diagonal
    poked = {p.index for p in source.data.polygons if p.center.z > 9.99}
    bpy.ops.object.fairing_flat_faces(angle=np.radians(0.01))
    assert len(poked) == 4 and not poked & set(marked(source))
    bpy.ops.object.fairing_flat_faces()
    assert poked < set(marked(source))


def test_flats_may_end_at_creases_as_those_that_auto_keeps():
    source = box()
    with bmesh_of(source.data) as mesh:
        everything = [*mesh.verts, *mesh.edges, *mesh.faces]
        plane = {"plane_co": (5.0, 0.0, 0.0), "plane_no": (1.0, 0.0, 0.0)}
        bmesh.ops.bisect_plane(mesh, geom=everything, clear_outer=True, **plane)
        rim = [edge for edge in mesh.edges if edge.is_boundary]
        bmesh.ops.contextual_create(mesh, geom=rim)
    bpy.ops.object.fairing_flat_faces()
    before = marked(source)
    cut = {v.index for v in source.data.vertices if v.co.x == 5.0}
    ends = [e.vertices[:] for e in source.data.edges if cut.issuperset(e.vertices)]
    set_edge_attribute(source.data, "crease_edge", "FLOAT", ends, 1.0)
    bpy.ops.object.fairing_flat_faces(clear=True)
    kept = Job(bpy.context, source, settings(interpolation="FLATS")).arguments["flat_faces"]
    bpy.ops.object.fairing_flat_faces()
    assert len(before) < len(kept) and marked(source) == kept.tolist()


@pytest.mark.parametrize("old", [False, True])
def test_selected_faces_are_marked_and_cleared(old, monkeypatch):
    """`old`: in a Blender that shows no Boolean layers in Edit Mode; the panel is drawn there too."""
    if old:
        monkeypatch.setitem(marks._OF_BMESH, "BOOLEAN", "")
    source = box()
    edit(source, "FACE")
    refused("Select faces first", bpy.ops.object.fairing_flat_faces)
    assert marks.count([source], FLAT) == 0
    to_object_mode()
    edit(source, "FACE", (3, 7))
    bpy.ops.object.fairing_flat_faces()
    assert bpy.context.mode == "EDIT_MESH" and marks.count([source], FLAT) == (0 if old else 2)
    to_object_mode()
    assert marked(source) == [3, 7]
    edit(source, "FACE", [7])
    bpy.ops.object.fairing_flat_faces(clear=True)
    to_object_mode()
    assert marked(source) == [3]


def flatness(surface):
    """The largest distance of points over the top's middle from its plane."""
    points = positions(surface.data)
    over = (np.abs(points[:, :2]) < 10.0).all(axis=1) & (points[:, 2] > 0)
    return np.abs(points[over, 2] - 10.0).max()


def test_the_surface_keeps_them_flat_until_they_are_cleared():
    source = box()
    surface = fair(levels=3, interpolation="EXACT")
    assert flatness(surface) > 0.1
    assert bpy.ops.object.fairing_flat_faces() == {"FINISHED"}, "its source is meant"
    assert len(marked(source)) == 30
    bpy.ops.object.fairing_recompute()
    assert flatness(surface) < 40 * 1e-4
    bpy.ops.object.fairing_flat_faces(clear=True)
    assert marked(source) == []
    bpy.ops.object.fairing_recompute()
    assert flatness(surface) > 0.1


def test_a_can_is_round_and_its_ends_are_plane():
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=33.0, depth=115.0)
    source = bpy.context.object
    with bmesh_of(source.data) as mesh:
        ends = [e for e in mesh.edges if abs(e.verts[0].co.z - e.verts[1].co.z) < 1e-3]
        bmesh.ops.bevel(mesh, geom=ends, offset=5.0, segments=2, profile=0.5, affect="EDGES")
    assert bpy.ops.object.fairing_flat_faces() == {"FINISHED"}
    points = positions(fair(levels=3).data)
    radius, height = np.hypot(*points[:, :2].T), np.abs(points[:, 2])
    assert radius.max() < 33.0 * 1.001 and height.max() < 57.5 * 1.0001
    assert radius[height < 52.0].min() > 33.0 * 0.999


def test_what_cannot_keep_them_says_so():
    source = box()

    def told(energy, interpolation="AUTO"):
        job = Job(bpy.context, source, settings(energy=energy, interpolation=interpolation))
        lines = [s for s in draw(main.VIEW3D_PT_fairing) if str(s).startswith("Flat faces:")]
        return "flat_faces" in job.arguments, [n for n in job.notes if "Flat faces" in n], lines

    assert told("TOTAL_CURVATURE") == (False, [], [])
    bpy.ops.object.fairing_flat_faces()
    kept, notes, lines = told("TOTAL_CURVATURE")
    assert not kept and len(notes) == 1 and "Choose Bending" in notes[0]
    assert lines == ["Flat faces: 30, choose Bending"]
    kept, notes, lines = told("THIN_PLATE", "LIMIT")
    assert not kept and len(notes) == 1 and "Through" in notes[0]
    assert lines == ["Flat faces: 30, choose Through"]
    assert told("THIN_PLATE") == (True, [], ["Flat faces: 30"])
