# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Hole Fair: the holes that it fills, its surfaces, and the data of the new faces."""

import bpy
import numpy as np
import pytest
from hole_scenes import ball, borders, is_closed, radii, without
from lattices import lattice_faces
from scenes import CUBE, activate, add, edit, positions, refused, to_object_mode


def test_larger_holes_stay_open():
    with pytest.raises(RuntimeError, match="no hole, every edge has a face on both sides"):
        whole = ball()
        bpy.ops.object.fairing_fill()
    target = without(whole, lambda c: c[2] > 0.5)
    count = len(target.data.polygons)
    refused(r"no hole of a width of at most 1.5 m", bpy.ops.object.fairing_fill, largest=1.5)
    assert len(target.data.polygons) == count
    target.scale = (0.1, 0.1, 0.1)  # a length is one of the scene
    assert bpy.ops.object.fairing_fill(largest=0.2) == {"FINISHED"}
    assert is_closed(target.data)


def test_the_border_of_a_sheet_stays_open():
    """Its holes, which have few edges, are filled."""
    points = [(x, y, 0.0) for x in range(7) for y in range(7)]
    faces = np.delete(lattice_faces(7, 7), 2 * 6 + 3, axis=0)
    target = add("Sheet", points, faces.tolist())
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    assert len(borders(target)) == 24
    refused("it seems to be that of a sheet", bpy.ops.object.fairing_fill)


def test_faces_that_are_not_joined_are_no_sheet():
    """As an STL file has them."""
    corners = np.array(CUBE[0])[np.array(CUBE[1])].reshape(-1, 3)
    activate(add("Box", corners.tolist(), np.arange(24).reshape(6, 4).tolist()))
    refused("Box: Merge vertices by distance", bpy.ops.object.fairing_fill)


def test_one_edge_names_its_hole():
    target = without(ball(), lambda c: abs(c[2]) > 0.7)
    target.scale = (1, 1, 2)  # filled as it is seen in the world
    edit(target, "EDGE")
    refused("Select a border edge", bpy.ops.object.fairing_fill)
    edit(target, "EDGE", borders(target, lambda z: z > 0)[:1])
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    to_object_mode()
    left = borders(target)
    assert left and borders(target, lambda z: z > 0) == []


def test_selected_faces_are_replaced():
    """Erase and fill removes a dent."""
    target = ball()
    for vertex in target.data.vertices:
        if vertex.co[2] > 0.8:
            vertex.co *= 0.7
    activate(target)
    dent = [f.index for f in target.data.polygons if f.center[2] > 0.5]
    edit(target, "FACE", dent)
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    to_object_mode()
    assert is_closed(target.data)
    assert np.abs(radii(target) - 1).max() < 1e-3
    assert sum(f.select for f in target.data.polygons) > 0


def place_of_corners(target, layer):
    """For each corner the place of its vertex, and its UV."""
    mesh = target.data
    at = np.array([mesh.vertices[loop.vertex_index].co for loop in mesh.loops])
    return at, np.array([corner.uv for corner in mesh.uv_layers[layer].data])


def test_uv_maps_and_weights_are_blended_from_the_rim():
    target = without(ball(), lambda c: c[2] > 0.7)
    map_, group = target.data.uv_layers.new(name="Map"), target.vertex_groups.new(name="Ramp")
    for loop in target.data.loops:
        map_.data[loop.index].uv = target.data.vertices[loop.vertex_index].co[:2]
    for vertex in target.data.vertices:
        group.add([vertex.index], 0.5 + 0.5 * vertex.co[0], "REPLACE")
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    at, uv = place_of_corners(target, "Map")
    assert np.abs(uv - at[:, :2]).max() < 0.1  # nearest: 0.6, in the middle
    weights = np.array([v.groups[0].weight for v in target.data.vertices])
    assert np.abs(weights - 0.5 - 0.5 * positions(target.data)[:, 0]).max() < 0.05


def test_a_seam_at_the_rim_is_not_blended_across():
    target = without(ball(), lambda c: c[2] > 0.7)
    map_ = target.data.uv_layers.new(name="Map")
    for face in target.data.polygons:
        for corner in face.loop_indices:
            map_.data[corner].uv = (float(face.center[0] > 0), 0.0)
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    _, uv = place_of_corners(target, "Map")
    assert set(uv[:, 0].tolist()) == {0.0, 1.0}


def test_why_one_of_several_cannot_be_filled_is_said(capfd):
    whole = ball("Whole")
    target = without(ball("Open"), lambda c: c[2] > 0.7)
    whole.select_set(True)
    assert bpy.ops.object.fairing_fill() == {"FINISHED"}
    assert is_closed(target.data)
    assert "Whole: Delete faces first: there is no hole" in capfd.readouterr().out
