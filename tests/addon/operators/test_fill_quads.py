# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Hole Fair makes grids of quads, in Object Mode, in Edit Mode and beside shape keys."""

import bpy
import numpy as np
import pytest
from hole_scenes import borders, is_closed
from lattices import lattice_faces
from scenes import activate, add, edit, positions, to_object_mode


def tube(chosen):
    """A closed ring of quads, radius 1, tube 0.5, without those with the `chosen` angles."""
    n, m = 48, 24
    a, b = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    away = 1 + 0.5 * np.cos(b)
    points = np.stack([away * np.cos(a), away * np.sin(a), 0.5 * np.sin(b)], -1).reshape(-1, 3)
    quads = lattice_faces(n, m, (True, True))
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    return add("Ring", points, quads[~chosen(i, j).ravel()].tolist())


def off(target):
    x, y, z = positions(target.data).T
    return abs(np.hypot(np.hypot(x, y) - 1, z) - 0.5).max()


def rectangle(i, j):
    return (i >= 3) & (i < 9) & (j >= 2) & (j < 6)


@pytest.mark.parametrize("way", ["append", "keys", "edit"])
def test_a_rectangle_of_quads_comes_back(way):
    target = tube(rectangle)
    activate(target)
    target.data.uv_layers.new()
    if way == "keys":
        target.shape_key_add(name="Basis")
    if way == "edit":
        edit(target, "EDGE", borders(target)[:1])
    count = len(target.data.polygons)
    assert bpy.ops.object.fairing_fill(quads=True) == {"FINISHED"}
    if way == "edit":
        to_object_mode()
    assert {len(face.vertices) for face in target.data.polygons} == {4}
    assert len(target.data.polygons) == count + 24
    assert is_closed(target.data) and not target.data.validate()
    assert off(target) < 0.005
    assert sum(face.select for face in target.data.polygons) == 24


def test_a_grid_beside_triangles():
    """One of two holes has no grid, so both kinds of faces are appended."""
    target = tube(lambda i, j: rectangle(i, j) | ((i - 30) ** 2 + (j - 14) ** 2 < 12))
    activate(target)
    assert bpy.ops.object.fairing_fill(quads=True) == {"FINISHED"}
    assert {len(face.vertices) for face in target.data.polygons} == {3, 4}
    assert is_closed(target.data) and not target.data.validate()
    assert off(target) < 0.02
