# SPDX-License-Identifier: GPL-3.0-or-later
"""Show Patches: the control points of the patches for CAD, as a NURBS surface."""

import bpy
import numpy as np
import pytest
from scenes import CUBE, activate, add, computed, fair, shown

from addon.cad.fit import PatchJob
from addon.errors import JobError
from addon.settings import PatchOptions

WANTED = PatchOptions(fit_tolerance=1e-4, fit_angle=1e-3, fit_levels=4)


def patches_of(target):
    return computed(PatchJob(bpy.context, target, WANTED))


def nurbs_of(target):
    """The new object beside `target`."""
    activate(target)
    assert bpy.ops.object.fairing_show_patches(fit_angle=1e-3, fit_levels=4) == {"FINISHED"}
    return bpy.context.active_object


def points(spline):
    """(u, v, 3), as a net of patches."""
    values = np.empty(4 * len(spline.points), np.float32)
    spline.points.foreach_get("co", values)
    grid = values.reshape(spline.point_count_v, spline.point_count_u, 4)
    assert (grid[..., 3] == 1).all()
    return grid[..., :3].transpose(1, 0, 2)


def house():
    """Quads and triangles, so patches of several sizes."""
    vertices = [*CUBE[0], (0, 0, 2.2)]
    faces = [face for face in CUBE[1] if set(face) != {1, 3, 5, 7}]
    return add("House", vertices, [*faces, (1, 5, 8), (5, 7, 8), (7, 3, 8), (3, 1, 8)])


def test_every_control_point_is_that_of_its_patch():
    target = house()
    patches, before = patches_of(target).patches, set(bpy.data.objects)
    surface = nurbs_of(target)
    assert set(bpy.data.objects) - before == {surface} and len(bpy.data.curves) == 1
    assert bpy.context.mode == "OBJECT"
    assert surface.type == "SURFACE" and surface.name == "House Patches"
    assert len(surface.data.splines) == len(patches) == 5 + 12
    for p, spline in enumerate(surface.data.splines):
        assert (points(spline) == patches.net(p).astype(np.float32)).all()
        assert spline.order_u == spline.order_v == 4
        assert spline.use_endpoint_u and spline.use_endpoint_v


def test_the_surface_that_blender_draws_is_the_one_of_cad():
    box = add("Box", *CUBE)
    bpy.context.scene.discrete_fairing.energy = "TOTAL_CURVATURE"
    radius = np.linalg.norm(shown(nurbs_of(box)), axis=1)
    assert len(radius) > 100 and np.allclose(radius, np.sqrt(3), rtol=3e-3)


def test_it_stands_where_its_source_is_and_has_its_materials():
    box = add("Box", *CUBE)
    box.location, box.scale = (3, 0, 0), (1, 2, 1)
    for name in ("Red", "Green"):
        box.data.materials.append(bpy.data.materials.new(name))
    box.data.polygons[4].material_index = 1
    surface = nurbs_of(box)
    assert tuple(surface.location) == (3, 0, 0) and tuple(surface.scale) == (1, 2, 1)
    assert [material.name for material in surface.data.materials] == ["Red", "Green"]
    assert [spline.material_index for spline in surface.data.splines].count(1) == 1
    corners = np.concatenate(
        [points(spline)[::-1][:1, :1].reshape(-1, 3) for spline in surface.data.splines]
    )
    assert np.allclose(np.abs(corners), 1, atol=1e-6)


def with_keys():
    """A box with two keys, one relative to the other and with a vertex group, and its surface."""
    box = add("Box", *CUBE)
    group = box.vertex_groups.new(name="Upper")
    group.add([v for v in range(8) if CUBE[0][v][2] > 0], 0.5, "REPLACE")
    for name, scale in (("Basis", (1, 1, 1)), ("Tall", (1, 1, 1.5)), ("Wide", (2, 1, 1.5))):
        key = box.shape_key_add(name=name, from_mix=False)
        key.data.foreach_set("co", np.float32(np.array(CUBE[0]) * scale).ravel())
    keys = box.data.shape_keys.key_blocks
    keys["Tall"].vertex_group = "Upper"
    keys["Wide"].relative_key = keys["Tall"]
    keys["Tall"].value, keys["Wide"].value = 0.8, 0.6
    return box, fair(energy="TOTAL_CURVATURE", levels=3)


@pytest.mark.parametrize("what", ["surface", "source"])
def test_patches_pass_where_shape_keys_have_the_surface(what):
    box, surface = with_keys()
    wanted = shown(surface)[:8]
    assert np.abs(wanted - CUBE[0]).max() > 0.3
    bpy.context.scene.discrete_fairing.energy = "TOTAL_CURVATURE"
    job = patches_of(box if what == "source" else surface)
    found = job.patches.vertices
    apart = np.linalg.norm(found[:, None] - wanted, axis=2).min(axis=1)
    assert len(found) == 8 and apart.max() < 1e-3
    assert job.apart is None if what == "source" else job.apart < 0.02
    surface.data.shape_keys.use_relative = False
    with pytest.raises(JobError, match="Switch on Relative"):
        PatchJob(bpy.context, surface, WANTED)


def test_keys_of_the_surface_alone_are_refused_with_a_cure():
    box = add("Box", *CUBE)
    surface = fair(levels=2)
    surface.shape_key_add(name="Basis")
    key = surface.shape_key_add(name="Dent")
    key.data[20].co *= 0.8
    key.value = 0.5
    with pytest.raises(JobError, match="Set the key Dent to 0"):
        PatchJob(bpy.context, surface, WANTED)
    key.value = 0.0
    # as far as the mesh of two levels is from the fair surface
    assert patches_of(surface).apart < 0.1
    box.shape_key_add(name="Basis")  # of a mesh itself they are in what is faired
    box.shape_key_add(name="Up").value = 1.0
    PatchJob(bpy.context, box, WANTED)


def test_the_largest_distance_from_the_mesh_shown_is_told(capfd):
    box = add("Box", *CUBE)
    surface = fair(energy="TOTAL_CURVATURE", levels=2)
    surface.scale = (3, 3, 3)
    surface.data.vertices[20].co *= 1.1  # no control vertex
    nurbs_of(surface)
    told = capfd.readouterr().out
    assert patches_of(surface).apart == pytest.approx(3 * 0.1 * np.sqrt(3), rel=0.02)
    assert "522 mm from the mesh shown, as Box Fair has 2 levels: " in told
    box.data.vertices[0].co *= 2  # the surface is that of the mesh before
    assert patches_of(surface).apart > 1
