# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices with a fixed normal are marked in Edit Mode, read, shown and carried on."""

import bpy
import numpy as np
import pytest
from mathutils import Vector
from scenes import computed, edit, fair, positions, settings, to_object_mode
from test_boundary_marks import sheet

from addon.jobs.fair import Job
from addon.mesh.marks import NORMAL, read
from addon.mesh.read import read_mesh
from addon.mesh.world_shape import world_shape

INSIDE = 5  # vertex (1, 1) of the sheet
TILTED = (0.6, 0.0, 0.8)


def fix(target, *vertices):
    edit(target, "VERT", vertices)
    answer = bpy.ops.object.fairing_fix_normal()
    to_object_mode()
    return answer


def set_normals(target, normals):
    """{vertex: vector} as the attribute."""
    layer = target.data.attributes.new(NORMAL.name, "FLOAT_VECTOR", "POINT")
    for vertex, normal in normals.items():
        layer.data[vertex].vector = normal


def marks(target):
    """{vertex: normal} of those that are fixed."""
    normals = read(target.data, NORMAL)
    return {} if normals is None else {int(v): normals[v] for v in np.flatnonzero(normals.any(1))}


def slope(surface, source, vertex, axis=0):
    """The slope of the surface at a vertex, dz/dx, from its neighbours on both sides."""
    points, at = positions(surface.data).astype(float), positions(source.data)[vertex]
    ends = [set(e.vertices) for e in surface.data.edges if vertex in e.vertices]
    along = points[sorted(set.union(*ends) - {vertex})] - at
    before, after = along[along[:, axis].argmin()], along[along[:, axis].argmax()]
    return (after[2] - before[2]) / (after[axis] - before[axis])


def test_the_normals_of_the_mesh_are_fixed_where_it_is_selected():
    source = sheet()
    own = [tuple(n.vector) for n in source.data.vertex_normals]
    assert fix(source, INSIDE, 6) == {"FINISHED"}
    found = marks(source)
    assert set(found) == {INSIDE, 6}
    for vertex, normal in found.items():
        assert np.allclose(normal, own[vertex], atol=1e-6)


def test_custom_normals_are_those_of_the_mesh():
    source = sheet()
    normals = [Vector(TILTED)] * len(source.data.vertices)
    source.data.normals_split_custom_set_from_vertices(normals)
    fix(source, INSIDE)
    assert np.allclose(marks(source)[INSIDE], TILTED, atol=1e-3)


def test_without_a_vertex_nothing_is_fixed():
    source = sheet()
    with pytest.raises(RuntimeError, match="Select a vertex with faces"):
        fix(source)
    assert bpy.ops.object.fairing_fix_normal.poll()
    to_object_mode()
    assert NORMAL.name not in source.data.attributes
    assert not bpy.ops.object.fairing_fix_normal.poll()
    assert not bpy.ops.object.fairing_free_normal.poll()


def test_normals_are_freed_again():
    source = sheet()
    fix(source, INSIDE, 6, 9)
    edit(source, "VERT", (6, 10))
    assert bpy.ops.object.fairing_free_normal() == {"FINISHED"}
    to_object_mode()
    assert set(marks(source)) == {INSIDE, 9}


@pytest.mark.parametrize("scale", [1, 3])
def test_the_surface_has_the_normal_in_the_world(scale):
    wanted = -TILTED[0] / TILTED[2]
    source = sheet()
    assert abs(slope(fair(levels=4), source, INSIDE) - wanted) > 0.2
    source = sheet("Tilted")
    set_normals(source, {INSIDE: TILTED})
    source.scale = (1, 1, scale)
    surface = fair(levels=4)
    assert slope(surface, source, INSIDE) == pytest.approx(wanted, abs=0.03)
    assert NORMAL.name not in surface.data.attributes
    assert np.array_equal(positions(surface.data)[:16], positions(source.data))
    in_the_world = world_shape(source).of_arrays(read_mesh(source.data)).normals[INSIDE]
    assert np.allclose(in_the_world, [0.6, 0, 0.8 / scale])


def test_the_other_energies_leave_them_out_and_say_so():
    source = sheet()
    set_normals(source, {0: TILTED, INSIDE: TILTED})
    job = Job(bpy.context, source, settings(energy="TOTAL_CURVATURE"))
    assert "normals" not in job.arguments
    assert any("only Bending" in note for note in job.notes)
    job = computed(Job(bpy.context, source, settings(energy="THIN_PLATE")))
    assert job.arguments["normals"].any(axis=1).sum() == 2
    assert not any("Bending" in note for note in job.notes)
    # those on the border
    assert any("not fixed" in warning and "(0)" in warning for warning in job.warnings())


def test_a_new_vertex_between_fixed_and_free_is_free():
    source = sheet()
    fix(source, INSIDE)
    edit(source, "VERT", (INSIDE, 6))
    bpy.ops.mesh.subdivide()
    to_object_mode()
    assert set(marks(source)) == {INSIDE}
