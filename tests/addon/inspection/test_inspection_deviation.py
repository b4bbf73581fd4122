# SPDX-License-Identifier: GPL-3.0-or-later
"""Deviation in colours: correct distances, and none that a drag would wait for."""

import bpy
import numpy as np
import pytest
from live_scenes import box, pull, session
from mathutils import bvhtree, kdtree
from scenes import activate, add_suzanne, positions

from addon.inspection import deviation, display
from addon.mesh.read import read_mesh
from addon.mesh.scans import read_scans


def near_surface():
    source = add_suzanne()
    options = {"interpolation": "APPROXIMATE", "tolerance": 0.05}
    bpy.ops.object.fairing_surface(levels=3, **options)
    return source, bpy.context.object


def brute_force(mesh, points):
    """Signed distances by a tree of the triangles that are drawn, each search by itself."""
    mesh.calc_loop_triangles()
    faces = [triangle.vertices[:] for triangle in mesh.loop_triangles]
    tree = bvhtree.BVHTree.FromPolygons(positions(mesh).tolist(), faces)
    found = [tree.find_nearest(point) for point in points.tolist()]
    places, normals = (np.array([tuple(item[i]) for item in found]) for i in (0, 1))
    outside = ((points - places) * normals).sum(axis=1) >= 0.0
    return np.where(outside, 1.0, -1.0) * [item[3] for item in found]


def test_from_vertices():
    source, surface = near_surface()
    arrays, control = read_mesh(surface.data), positions(source.data).astype(float)
    found = deviation.from_vertices(surface, arrays.positions, control)
    tree = kdtree.KDTree(len(control))
    for k, place in enumerate(control):
        tree.insert(place, k)
    tree.balance()
    nearest = [tree.find(place)[1] for place in arrays.positions]
    expected = -brute_force(surface.data, control)[nearest]
    assert np.abs(expected).max() > 1e-3 and np.allclose(np.abs(found), np.abs(expected), atol=1e-6)
    # at two vertices the nearest place is a sharp corner, whose faces look either way
    assert np.isclose(found, expected, atol=1e-6).mean() > 0.99


@pytest.mark.parametrize("order", ["as they follow", "any"])
def test_from_an_object_each_search_begins_at_the_last_place(order):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    ball = bpy.context.object
    arrays, rng = read_mesh(ball.data), np.random.default_rng(3)
    points = arrays.positions * rng.uniform(0.5, 1.5, (len(arrays.positions), 1))
    if order == "any":
        rng.shuffle(points)
    found = deviation.from_scan(ball, points, read_scans(bpy.context, [ball]))
    expected = brute_force(ball.data, points)
    assert (found < -0.1).any() and (found > 0.1).any()
    assert np.allclose(found, expected, atol=1e-5)


@pytest.mark.parametrize("quick", [True, False])
def test_a_drag_waits_for_no_measurement(monkeypatch, no_pause, quick):
    source, target = box()
    activate(target)
    bpy.ops.object.fairing_inspect(mode="DEVIATION")
    monkeypatch.setattr(display, "QUICK", 10**6 if quick else 0)
    measured, measure = [], deviation.from_vertices
    monkeypatch.setattr(deviation, "from_vertices", lambda *a: measured.append(1) or measure(*a))
    measured.clear()
    pull(source)
    assert bool(measured) == quick
    assert len(target.data.vertices) == len(target.data.attributes["fair_deviation"].data)
    assert display.COLOUR in target.data.color_attributes
    measured.clear()
    session(target).complete(bpy.context)
    assert measured, "with the full level"
