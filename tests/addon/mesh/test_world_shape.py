# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh is faired in the shape that its object's scale gives it."""

import bpy
import numpy as np
import pytest
from live_scenes import through
from scenes import CUBE, add, fair, positions

from addon.mesh.world_shape import world_shape

UNEVEN = (1.0, 3.0, 0.4)


def stretched(source):
    """The source's vertices, stretched by its scale."""
    return world_shape(source).of(positions(source.data).astype(float))


def of_applied_scale(source, **settings):
    """The surface as it is after Apply Scale."""
    baked = add("Applied", *CUBE)
    baked.data = source.data.copy()
    baked.data.vertices.foreach_set("co", np.float32(stretched(source)).ravel())
    return positions(fair(**settings).data)


def in_the_world(result):
    return world_shape(result).of(positions(result.data).astype(float))


@pytest.mark.parametrize("energy", ["THIN_PLATE", "TOTAL_CURVATURE"])
def test_apply_scale_changes_nothing(source, energy):
    source.scale = UNEVEN
    result = fair(levels=3, energy=energy)
    assert through(result, source), "to the bit"
    expected = of_applied_scale(source, levels=3, energy=energy)
    assert np.abs(in_the_world(result) - expected).max() < 1e-4
    add("Plain", *CUBE)
    object_space = positions(fair(levels=3, energy=energy).data)
    assert np.abs(object_space - positions(result.data)).max() > 0.01, "else the test says nothing"


@pytest.mark.parametrize("scale", [(0.1, 0.1, 0.1), UNEVEN])
def test_a_tolerance_is_a_length_in_the_scene(source, scale):
    source.scale = scale
    result = fair(levels=1, interpolation="APPROXIMATE", tolerance=0.02, tolerance_unit="SCENE")
    missed = np.linalg.norm(in_the_world(result)[:8] - stretched(source), axis=1)
    assert 0.9 * 0.02 < missed.max() <= 0.02 * (1 + 1e-4)


def test_parents_count():
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale = (1.0, 1.0, 4.0)
    source = add("Box", *CUBE)
    source.parent, source.rotation_euler = parent, (0.5, 0.0, 0.0)
    source.location = (1.0, 2.0, 3.0)
    shape = world_shape(source)
    bpy.context.view_layer.update()
    linear = np.array(source.matrix_world.to_3x3())
    points = np.random.default_rng(1).normal(size=(5, 3))
    there = np.linalg.norm(points @ linear.T, axis=1)
    assert np.allclose(np.linalg.norm(shape.of(points), axis=1), there, rtol=1e-5)
    assert fair(levels=1) is not None
