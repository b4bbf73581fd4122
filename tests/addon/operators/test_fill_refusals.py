# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders that are no holes are reported, in Blender and on the command line."""

import bmesh
import bpy
import numpy as np
import pytest
from fake_layout import draw
from hole_scenes import ball, borders, is_closed, without
from scenes import add, bmesh_of, edit, refused, to_object_mode

from addon.check.defects import recall_defects
from addon.ui.inspect import VIEW3D_PT_fairing_check


def with_a_fin():
    """A ball with two holes; at the rim of one a third face stands on an edge."""
    target = without(ball(), lambda c: abs(c[2]) > 0.7)
    with bmesh_of(target.data) as bm:
        edge = next(e for e in bm.edges if e.is_boundary and e.verts[0].co[2] > 0)
        inner = next(e for v in edge.verts for e in v.link_edges if not e.is_boundary)
        bm.faces.new([*inner.verts, bm.verts.new(2 * inner.verts[0].co)])
    return target


def test_alone_it_is_refused_in_object_and_edit_mode():
    target = with_a_fin()
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    faces = len(target.data.polygons)
    refused("around no hole, because more than two", bpy.ops.object.fairing_fill)
    edit(target, "EDGE", borders(target, lambda z: z > 0)[:1])
    refused("1 border edge is around no hole", bpy.ops.object.fairing_fill)
    to_object_mode()
    assert len(target.data.polygons) == faces


def codes(target):
    return [defect["code"] for defect in recall_defects(target)[0]]


def test_a_fin_is_listed_and_a_button_deletes_it():
    target = with_a_fin()
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    assert codes(target) == ["NONMANIFOLD_EDGE"]
    faces = len(target.data.polygons)
    assert bpy.ops.object.fairing_repair(index=0) == {"FINISHED"}
    to_object_mode()
    assert len(target.data.polygons) == faces - 1
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    assert is_closed(target.data)


def with_a_map(name, points, faces):
    """Its UV map is its plan."""
    target = add(name, points, faces)
    uv = target.data.uv_layers.new(name="Map")
    for loop in target.data.loops:
        uv.data[loop.index].uv = target.data.vertices[loop.vertex_index].co[:2]
    return target


def keeps_its_map(mesh):
    uv = mesh.uv_layers["Map"].data
    return all(
        np.allclose(uv[loop.index].uv, mesh.vertices[loop.vertex_index].co[:2], atol=1e-6)
        for loop in mesh.loops
    )


@pytest.mark.parametrize("edit_mode", [False, True])
@pytest.mark.parametrize(("triangles", "sizes"), [(False, [4, 4, 5]), (True, [3] * 7)])
def test_edges_are_cut_at_the_vertices_on_them(triangles, sizes, edit_mode, capfd):
    """Two quads beside a longer one, twice as high: the corner between them hangs on its edge."""
    points = [(0, 0), (1, 0), (1, 2), (0, 2), (1, 1), (2, 0), (2, 1), (2, 2)]
    faces = [(0, 1, 2, 3), (1, 5, 6, 4), (4, 6, 7, 2)]
    if triangles:
        faces = [half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))]
    target = with_a_map("Hanging", [(*p, 0) for p in points], faces)
    if edit_mode:
        side = [e.index for e in target.data.edges if set(e.vertices) == {1, 2}]
        edit(target, "EDGE", side)
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    assert "1 edge cut at a vertex on it" in capfd.readouterr().out
    to_object_mode()
    assert len(borders(target)) == 7 and len(target.data.vertices) == 8
    assert sorted(len(face.vertices) for face in target.data.polygons) == sizes
    assert keeps_its_map(target.data)


def test_a_vertex_on_an_edge_is_listed(capfd):
    """A rim that runs to and fro along a line more than once is no hole, and no cut closes it."""
    points = [(x, 0, 0) for x in (0, 3, 1, 2)] + [(1.5, y, z) for y in (-1, 1) for z in (-1, 1)]
    faces = [(b, a, 4 + k) for k, (a, b) in enumerate([(0, 1), (1, 2), (2, 3), (3, 0)])]
    target = with_a_map("Fold", points, faces)
    with pytest.raises(RuntimeError, match="Fold: 1 hole left, listed in the panel Check"):
        bpy.ops.object.fairing_fill(edge=(0, 1))
    defects, stale = recall_defects(target)
    assert not stale and defects[-1]["code"] == "VERTEX_ON_EDGE"
    panel = draw(VIEW3D_PT_fairing_check)
    assert "object.fairing_select_defect" in panel
    assert "1 vertex lies on a border edge" in " ".join(map(str, panel))


def test_a_slit_is_left_and_listed_with_buttons_to_select_and_mend_it(capfd):
    target = without(ball(), lambda c: c[2] > 0.7)
    mesh = target.data
    with bmesh_of(mesh) as bm:
        low = min(bm.edges, key=lambda e: sum(v.co.z for v in e.verts))
        beside = next(e for e in low.verts[1].link_edges if e != low)
        bmesh.ops.split_edges(bm, edges=[low, beside])
    before = len(mesh.polygons)
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    assert len(mesh.polygons) > before
    assert "1 hole left, listed in the panel Check" in capfd.readouterr().out
    defects, stale = recall_defects(target)
    assert not stale and [d["code"] for d in defects] == ["COINCIDENT_VERTICES"]
    assert bpy.ops.object.fairing_repair(index=0) == {"FINISHED"}
    to_object_mode()
    assert is_closed(mesh)
