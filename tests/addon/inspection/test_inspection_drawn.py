# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawings over the viewport as arrays: section curves, combs and deviation."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from lattices import lattice_faces
from refined import values
from scenes import CUBE, activate, add, edit

from addon.inspection import overlay_arrays, sections
from addon.inspection.sections import drawn


def ball(radius=2.0, subdivisions=5):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, radius=radius)
    bpy.ops.object.shade_smooth()
    return bpy.context.object


def surface(target):
    return overlay_arrays.surface_of(target, bpy.context.evaluated_depsgraph_get())


def test_corners_share_points_where_the_surface_is_smooth():
    smooth = surface(ball())
    assert len(smooth.points) == len(bpy.context.object.data.vertices)
    assert np.allclose(np.linalg.norm(smooth.normals, axis=1), 1.0, atol=1e-5)
    assert np.allclose(smooth.normals, smooth.points / 2.0, atol=0.01)
    box = add("Box", *CUBE)
    rounded = overlay_arrays.surface_of(box, bpy.context.evaluated_depsgraph_get(), smooth=True)
    assert len(np.unique(rounded.triangles)) == 8, "as if it had no flat faces"
    flat = surface(box)
    used = np.unique(flat.triangles)
    assert len(used) == 24 and len(flat.triangles) == 12, "three normals a vertex of a cube"
    a, b, c = (flat.points[flat.triangles[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    for corner in range(3):
        assert np.allclose(flat.normals[flat.triangles[:, corner]], normals, atol=1e-5)


def test_loose_vertices_and_no_faces_draw_nothing():
    no_faces = np.empty(0, np.int32), np.empty((0, 3)), np.empty((0, 3), np.int32)
    found = drawn(np.zeros((3, 3)), *no_faces)
    assert len(found.triangles) == 0 and not found.normals.any()
    assert sections.sections(found, 0, 5) == []


def test_the_edits_of_edit_mode_are_drawn():
    box = add("Box", *CUBE)
    edit(box, "VERT", range(8))
    bpy.ops.transform.resize(value=(3, 1, 1))
    assert np.abs(surface(box).points[:, 0]).max() == pytest.approx(3)


def test_sections_of_a_sphere_are_circles_of_the_right_size_and_bend():
    target = surface(ball(radius=2.0))
    for axis in range(3):
        found = sections.sections(target, axis, 4)
        assert len(found) == 4 and all(section.closed for section in found)
        for section, height in zip(found, (-1.5, -0.5, 0.5, 1.5), strict=True):
            assert np.allclose(section.points[:, axis], height, atol=1e-6)
            assert np.array_equal(section.points[0], section.points[-1])
            size = np.sqrt(4.0 - height**2)
            across = np.delete(section.points, axis, axis=1)
            assert np.allclose(np.linalg.norm(across, axis=1), size, rtol=5e-3)
            assert np.allclose(section.curvature, 1.0 / size, rtol=0.03)
            ends = sections.combs([section], 4.0)[0]
            outward = np.linalg.norm(np.delete(ends, axis, axis=1), axis=1)
            assert np.all(outward > size), "teeth stand on the side that bulges"


def test_a_hollow_bends_the_other_way():
    target = ball(radius=2.0)
    target.data.flip_normals()
    for section in sections.sections(surface(target), 2, 3):
        assert section.curvature.max() < 0.0
        ends = sections.combs([section], 4.0)[0]
        out, at = (np.linalg.norm(p[:, :2], axis=1) for p in (ends, section.points))
        assert np.all(out > at), "against normals that look inwards"


def test_sections_end_at_borders_and_break_at_sharp_edges():
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=2)
    (line,) = sections.sections(surface(bpy.context.object), 0, 1)
    assert not line.closed and np.abs(line.curvature).max() < 1e-6
    assert np.ptp(line.points[:, 1]) == pytest.approx(2.0)
    found = sections.sections(surface(add("Box", *CUBE)), 2, 1)
    assert len(found) == 4 and not any(section.closed for section in found)
    assert max(np.abs(section.curvature).max() for section in found) < 1e-6


def asked(axes, count):
    return SimpleNamespace(section_axes=axes, section_count=count, show_combs=True, comb_scale=1.0)


def test_lines_come_in_pairs_for_what_is_asked():
    target, wanted = surface(ball()), asked({"X", "Z"}, 3)
    (curves, _), *over = overlay_arrays.lines_of(target, wanted)
    assert np.abs(np.linalg.norm(curves, axis=1) - 2.0).max() < 0.01
    assert len(over) == 4 and len({colour[:3] for _, colour in over}) == 2, "a colour for an axis"
    assert all(len(points) % 2 == 0 for points in (curves, *(points for points, _ in over)))
    assert all(np.linalg.norm(over[k][0], axis=1).min() > 2.1 for k in (1, 3))
    wanted.show_combs = False
    assert len(overlay_arrays.lines_of(target, wanted)) == 1


def test_combs_of_the_axis_that_bends_less_are_as_long():
    """A half cylinder of 1 by 20: sections along it are straight but for a bend of a hundredth."""
    x, angle = np.meshgrid(np.linspace(-10, 10, 41), np.linspace(0, np.pi, 17), indexing="ij")
    points = np.stack([x, np.cos(angle), np.sin(angle) - 0.001 * x**2], axis=-1).reshape(-1, 3)
    target = add("Half Tube", points.tolist(), lattice_faces(*x.shape).tolist())
    bpy.ops.object.shade_smooth()
    lines = overlay_arrays.lines_of(surface(target), asked({"X", "Y"}, 4))
    _, across, _, along, _ = (points for points, _ in lines)
    longest = [np.linalg.norm(teeth[1::2] - teeth[::2], axis=1).max() for teeth in (across, along)]
    assert 0.3 < longest[1] / longest[0] < 3.0


def deviation(target):
    return values(target.data, "fair_deviation")


def show_deviation(target):
    activate(target)
    assert bpy.ops.object.fairing_inspect(mode="DEVIATION") == {"FINISHED"}
    return deviation(target)


def test_deviation_from_another_object_has_signs_and_follows_the_choice():
    small, large = ball(radius=2.0), ball(radius=2.1)
    large.location.x = 0.0
    scene = bpy.context.scene.discrete_fairing_inspection
    scene.deviation_object = small
    assert np.abs(show_deviation(small)).max() < 1e-6, "of itself"
    assert show_deviation(large) == pytest.approx(0.1, abs=5e-3)
    scene.deviation_object = large
    assert deviation(small) == pytest.approx(-0.1, abs=5e-3)
    small.scale = (1.05,) * 3
    bpy.context.view_layer.update()
    bpy.ops.object.fairing_refresh()
    assert np.abs(show_deviation(small)).max() < 1e-2, "as they are in the world"


def test_deviation_from_control_vertices(source):
    assert np.array_equal(show_deviation(source), np.zeros(8)), "no control vertices"
    bpy.ops.object.fairing_surface(levels=2, interpolation="EXACT")
    through = bpy.context.object
    assert np.abs(show_deviation(through)).max() < 1e-5
    activate(source)
    bpy.ops.object.fairing_surface(
        levels=2, interpolation="APPROXIMATE", tolerance=0.1, tolerance_unit="SCENE"
    )
    near = bpy.context.object
    missed = show_deviation(near)
    assert 1e-3 < np.abs(missed).max() <= 0.1 + 1e-6 and missed.max() <= 0.0, "inside of them"
    near.location.x = 9.0
    bpy.context.view_layer.update()
    bpy.ops.object.fairing_refresh()
    assert np.array_equal(deviation(near), missed), "wherever the surface has been put"
    bpy.ops.object.fairing_inspect(mode="NONE")
    assert "fair_deviation" not in near.data.attributes
