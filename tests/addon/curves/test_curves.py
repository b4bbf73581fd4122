# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface from Curves: the curves that it reads, its surface, and how that follows them."""

import bpy
import networks
import numpy as np
import pytest
from curve_objects import poly, scene, surface
from mathutils import Matrix
from scenes import activate, add, positions, recompute, refused, shown

from addon.curves.cubics import points_at
from addon.live import registry, switch
from addon.mesh.read_curves import read_curves
from addon.surfaces import curve_cage, freshness


def square():
    return networks.polygon(4)


def even(curve, count=400):
    return points_at(curve.pieces, np.linspace(0, curve.end, count))


def test_it_makes_a_surface_through_the_curves():
    made = scene(networks.three_by_four)
    target = surface()
    assert target.discrete_fairing.energy == "MINIMUM_VARIATION"
    cage = target.discrete_fairing.source
    assert curve_cage.curves_of(cage) == [made[name] for name in sorted(made)]
    assert cage.hide_get() and not any(o.hide_get() for o in made.values())
    x, y, z = positions(target.data).T
    assert np.abs(z - networks.crown(x, y)).max() < 2e-3
    assert len(target.data.polygons) == 4**3 * len(cage.data.polygons)


@pytest.mark.parametrize("endpoint, cyclic, weighted", [(1, 0, 0), (0, 0, 0), (0, 1, 0), (1, 0, 1)])
def test_nurbs_are_where_blender_draws_them(endpoint, cyclic, weighted):
    random = np.random.default_rng(1)
    points = np.stack([np.cos(np.arange(7)), np.sin(np.arange(7)), random.random(7)], axis=1)
    drawn = poly("Curve", points, bool(cyclic), "NURBS")
    spline = drawn.data.splines[0]
    spline.use_endpoint_u, spline.order_u, spline.resolution_u = bool(endpoint), 4, 8
    if weighted:
        spline.points[3].co[3] = 3.0
    drawn.matrix_world = Matrix([[0, -2, 0, 1], [2, 0, 0, 0], [0, 0, 2, 5], [0, 0, 0, 1]])
    bpy.context.view_layer.update()
    theirs = shown(drawn) @ np.array(drawn.matrix_world)[:3, :3].T + (1, 0, 5)
    [ours] = read_curves(drawn)
    ours = even(ours, 4000)
    gaps = [np.linalg.norm(ours - point, axis=1).min() for point in theirs]
    assert len(gaps) > 20 and max(gaps) < 5e-3
    assert np.abs(theirs.min(axis=0) - ours.min(axis=0)).max() < 0.02


def test_poly_curves_and_wire_edges_pass_their_points():
    points = [(np.cos(a), np.sin(a), 0.0) for a in np.linspace(0, 3, 7)]
    curve = poly("Poly", points)
    wire = add("Wire", points, [], [(k, k + 1) for k in range(6)])
    for source in (curve, wire):
        [read] = read_curves(source)
        assert np.abs(np.linalg.norm(even(read), axis=1) - 1).max() < 2e-3
        assert read.name == source.name and not read.closed


def test_a_refusal_leaves_nothing_behind():
    made = scene(lambda: networks.bonnet()[:4])
    before = set(bpy.data.objects), set(bpy.data.meshes)
    refused("No two of them come nearer", bpy.ops.object.fairing_curves)
    assert (set(bpy.data.objects), set(bpy.data.meshes)) == before and len(made) == 4


def test_recompute_follows_the_curves():
    made = scene(networks.three_by_four)
    target = surface(levels=2)
    before = positions(target.data)
    assert not freshness.why_stale(target)
    for curve in made.values():
        curve.location.z += 1.0
    bpy.context.view_layer.update()
    assert freshness.why_stale(target) == freshness.SOURCE_CHANGED
    recompute(target)
    assert np.abs(positions(target.data) - before - (0, 0, 1)).max() < 1e-5
    assert not freshness.why_stale(target)


def test_live_follows_a_handle(no_pause):
    made = scene(networks.three_by_four)
    target = surface(levels=2, energy="THIN_PLATE")
    target.discrete_fairing_live.on = True
    before = positions(target.data)
    # between two crossings: the network stays as it is
    point = made["Row 1"].data.splines[0].bezier_points[4]
    for part in ("co", "handle_left", "handle_right"):
        getattr(point, part).z += 0.2
    bpy.context.view_layer.update()
    after = positions(target.data)
    assert not switch.problem(target)
    assert len(after) == len(before) and 0.1 < np.abs(after - before)[:, 2].max() < 0.3


def test_live_says_why_it_waits_and_goes_on(no_pause):
    made = scene(square)
    target = surface(levels=1, energy="THIN_PLATE")
    target.discrete_fairing_live.on = True
    made["Side 0"].location.z += 1.0
    bpy.context.view_layer.update()
    assert "enclose nothing" in switch.problem(target)
    made["Side 0"].location.z -= 1.0
    bpy.context.view_layer.update()
    assert not switch.problem(target) and registry.session_of(target) is not None


def test_a_sharp_curve_leaves_a_crease():
    made = scene(networks.three_by_four)
    made["Row 1"].discrete_fairing_curves.sharp = True
    cage = surface(levels=1).discrete_fairing.source
    values = [edge.value for edge in cage.data.attributes["crease_edge"].data]
    points, ends = positions(cage.data), [edge.vertices[:] for edge in cage.data.edges]
    creased = points[[pair for pair, value in zip(ends, values, strict=True) if value]]
    assert np.abs(creased[..., 1]).max() < 1e-6
    ways = np.linalg.norm(creased[:, 0] - creased[:, 1], axis=1)
    assert ways.sum() == pytest.approx(2.05, abs=0.03)


def test_deleted_curves_are_told(no_pause):
    made = scene(square)
    target = surface(levels=1)
    for curve in made.values():
        bpy.data.objects.remove(curve)
    activate(target)
    refused("The curves of .* were deleted", bpy.ops.object.fairing_recompute)
