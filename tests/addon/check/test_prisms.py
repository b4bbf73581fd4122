# SPDX-License-Identifier: GPL-3.0-or-later
"""Regular turns that a crease angle leaves as prisms are told."""

import bpy
import pytest
from scenes import add_rounded_box, settings

from addon.check.turns import prisms_text
from addon.jobs.fair import Job
from addon.mesh.read import read_mesh

MECHANICAL = {"use_crease_angle": True, "crease_angle": 0.523599}


def told(mesh, **changes):
    return prisms_text(read_mesh(mesh), settings(**(MECHANICAL | changes)))


def cylinder(sides):
    bpy.ops.mesh.primitive_cylinder_add(vertices=sides)
    return bpy.context.object.data


@pytest.mark.parametrize("sides", [8, 10])
def test_turns_of_few_sides_are_told(sides):
    assert f"turn of {sides} sides" in told(cylinder(sides))


@pytest.mark.parametrize("sides", [6, 12])
def test_nuts_stay_and_finer_turns_are_round(sides):
    assert not told(cylinder(sides))


def test_no_word_about_marked_edges_bevelled_squares_and_without_a_crease_angle():
    mesh = cylinder(8)
    assert not told(mesh, use_crease_angle=False)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.edges.foreach_set("use_edge_sharp", [True] * len(mesh.edges))
    assert not told(mesh, use_sharp_edges=True)
    assert not told(add_rounded_box((4, 4, 4), 0.5, 1).data)


def test_the_job_tells_it():
    cylinder(8)
    notes = Job(bpy.context, bpy.context.object, settings(**MECHANICAL)).notes
    assert any("turn of 8 sides stays a prism" in note for note in notes)
