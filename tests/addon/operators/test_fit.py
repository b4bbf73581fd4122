# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface on Scan: scans and cages where they stand, and cages that are made."""

import bpy
import numpy as np
import pytest
from scenes import activate, add, positions


def ball(name, segments, radius=1.0, noise=0.0):
    """An icosphere, subdivided so often, its vertices off the sphere by noise."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=segments, radius=radius)
    made = bpy.context.object
    made.name = name
    if noise:
        points = positions(made.data)
        length = np.random.default_rng(1).normal(1, noise, (len(points), 1))
        made.data.vertices.foreach_set("co", (points * length).ravel())
        made.data.update()
    return made


def cage_of_cube():
    points = 0.6 * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return add("Cage", points.tolist(), quads)


def select(*objects):
    """The last one active."""
    activate(objects[-1])
    for other in objects:
        other.select_set(True)


def world(target):
    matrix = np.array(target.matrix_world)
    return positions(target.data) @ matrix[:3, :3].T + matrix[:3, 3]


def test_a_cage_is_drawn_onto_the_scan():
    scan, cage = ball("Scan", 5, noise=0.01), cage_of_cube()
    before = positions(cage.data).copy()
    select(scan, cage)
    assert bpy.ops.object.fairing_fit(levels=3) == {"FINISHED"}
    made = bpy.context.active_object
    assert made.name == "Cage Fit" and made not in (scan, cage)
    radii = np.linalg.norm(world(made), axis=1)
    assert len(radii) == 386
    assert np.sqrt(np.mean((radii - 1) ** 2)) < 0.007  # with noise of 0.01, and cells of 0.2
    assert np.array_equal(positions(cage.data), before)


def test_places_and_scales_of_both_count():
    scan, cage = ball("Scan", 4), cage_of_cube()
    scan.location, scan.scale, scan.rotation_euler = (5, 1, 0), (2, 1, 1), (0.3, 0, 0.2)
    cage.location, cage.scale = (5, 1, 0), (3, 2, 2)
    bpy.context.view_layer.update()
    select(scan, cage)
    assert bpy.ops.object.fairing_fit(levels=3) == {"FINISHED"}
    back = np.linalg.inv(np.array(scan.matrix_world))
    points = world(bpy.context.active_object)
    radii = np.linalg.norm(points @ back[:3, :3].T + back[:3, 3], axis=1)
    assert np.abs(radii - 1).max() < 0.03


def test_modifiers_of_the_scan_count():
    scan, cage = ball("Scan", 3), cage_of_cube()
    scan.modifiers.new("Size", "CAST").factor = 0.0
    grow = scan.modifiers.new("Grow", "DISPLACE")
    grow.strength, grow.mid_level = 0.2, 0.0
    select(scan, cage)
    assert bpy.ops.object.fairing_fit(levels=2) == {"FINISHED"}
    assert np.linalg.norm(world(bpy.context.active_object), axis=1).mean() > 1.1


def test_a_scan_alone_gets_a_cage():
    scan = ball("Scan", 5, noise=0.003)
    activate(scan)
    assert bpy.ops.object.fairing_fit(levels=2, cage_faces=100) == {"FINISHED"}
    made = bpy.context.active_object
    cage = bpy.data.objects["Scan Cage"]
    assert 20 < len(cage.data.polygons) < 400
    assert made.name == "Scan Cage Fit"
    assert np.abs(np.linalg.norm(world(made), axis=1) - 1).max() < 0.01


def test_tolerance_is_a_length_of_the_scene(capsys):
    scan, cage = ball("Scan", 5, noise=0.002), cage_of_cube()
    select(scan, cage)
    assert bpy.ops.object.fairing_fit(levels=3, amount="TOLERANCE", tolerance=0.02) == {"FINISHED"}
    said = capsys.readouterr().out
    assert "of 95 % of the scan; its noise is about" in said


def test_what_cannot_be_fitted_is_said():
    scan, cage = ball("Scan", 3), cage_of_cube()
    scan.scale = (1000, 1000, 1000)
    bpy.context.view_layer.update()
    select(scan, cage)
    with pytest.raises(RuntimeError, match="units of length"):
        bpy.ops.object.fairing_fit()
    count = len(bpy.data.objects)
    activate(cage)
    cage.select_set(False)
    with pytest.raises(RuntimeError, match="Select the scan"):
        bpy.ops.object.fairing_fit()
    assert len(bpy.data.objects) == count
