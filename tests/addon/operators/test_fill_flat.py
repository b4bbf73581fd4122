# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat: caps and transoms without new vertices, between rims that stay sharp."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from hole_scenes import ball, borders, without
from scenes import edit, to_object_mode

from addon.jobs.fill import FillOptions, HoleJob
from addon.operators.hull import in_metres
from addon.yard.hydrostatics import solid


def tube():
    """A prism with 48 sides, open at both ends."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=48, radius=1.0, depth=2.0, end_fill_type="NOTHING")
    return bpy.context.active_object


def test_a_cap_is_flat_and_its_rim_sharp():
    target = tube()
    edit(target, "EDGE", borders(target))
    before = len(target.data.vertices)
    assert bpy.ops.object.fairing_fill(joint="FLAT") == {"FINISHED"}
    to_object_mode()
    mesh = target.data
    assert len(mesh.vertices) == before and len(mesh.polygons) == 48 + 2 * 46
    found = solid(*in_metres(bpy.context, target))
    assert found.volume == pytest.approx(2 * 24 * np.sin(2 * np.pi / 48), rel=1e-6)
    rims = [
        e for e in mesh.edges if abs(np.ptp([mesh.vertices[v].co.z for v in e.vertices])) < 1e-6
    ]
    sharp = [e for e in rims if e.use_edge_sharp]
    assert len(sharp) == 96 and len(rims) == 96 + 2 * 45


def test_caps_are_offered_flat_and_repairs_are_not():
    options = FillOptions("CURVATURE", "THIN_PLATE", 1.0, 0.0, False)
    target = tube()
    assert HoleJob(bpy.context, target, replace(options, largest=9.0)).closes_caps
    edit(target, "EDGE", borders(target, lambda z: z > 0))
    assert HoleJob(bpy.context, target, options).closes_caps
    to_object_mode()
    target.data.vertices[1].co.z += 0.05  # no longer in a plane
    edit(target, "EDGE", borders(target, lambda z: z > 0))
    assert not HoleJob(bpy.context, target, options).closes_caps
    to_object_mode()
    target = without(ball(), lambda centre: centre.z > 0.9)
    for vertex in target.data.vertices:
        vertex.co.z = min(vertex.co.z, 0.88)  # the rim of a repair may be planar, too
    edit(target, "EDGE", borders(target))
    assert not HoleJob(bpy.context, target, options).closes_caps
