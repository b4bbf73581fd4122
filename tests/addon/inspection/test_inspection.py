# SPDX-License-Identifier: GPL-3.0-or-later
"""Zebra, curvature colours and the read-out on real objects: shown, saved, and put back exactly."""

import bpy
import numpy as np
import pytest
from scenes import CUBE, activate, add, reopen, snapshot

from addon.inspection import colours, display
from addon.inspection.materials import COLOUR, STRIPES
from addon.inspection.settings import MODES

SHOWN = [key for key, *_ in MODES if key != "NONE"]


def show(target, mode):
    activate(target)
    assert bpy.ops.object.fairing_inspect(mode=mode) == {"FINISHED"}


def evaluated(target):
    graph = bpy.context.evaluated_depsgraph_get()
    return target.evaluated_get(graph).data


def shown_materials(target):
    """Names of the materials that the faces show."""
    mesh = evaluated(target)
    return {mesh.materials[p.material_index].name for p in mesh.polygons if mesh.materials}


def two_materials(target):
    """One slot is linked to the mesh; one is linked to the object and hides another material."""
    red, green, blue = (bpy.data.materials.new(n) for n in ("Red", "Green", "Blue"))
    target.data.materials.append(red)
    target.data.materials.append(green)
    target.material_slots[1].link = "OBJECT"
    target.material_slots[1].material = blue
    target.data.polygons[0].material_index = 1


def slots(target):
    return [(s.link, s.material and s.material.name) for s in target.material_slots]


@pytest.mark.parametrize("mode", SHOWN)
def test_all_faces_show_it_and_off_leaves_no_trace(mode):
    box = add("Box", *CUBE)
    two_materials(box)
    before, slots_before = snapshot(box), slots(box)
    show(box, mode)
    assert shown_materials(box) == {STRIPES.get(mode, "Fairing Curvature")}
    assert slots(box) == slots_before
    show(box, "NONE")
    assert (snapshot(box), slots(box)) == (before, slots_before)
    assert not box.modifiers and not bpy.data.node_groups
    assert {m.name for m in bpy.data.materials} == {"Red", "Green", "Blue"}
    assert display.legend(box.data) is None


def test_the_users_active_colours_stay():
    box = add("Box", *CUBE)
    box.data.color_attributes.new("Mine", "BYTE_COLOR", "CORNER")
    box.data.color_attributes.active_color = box.data.color_attributes["Mine"]
    for mode in ("TOTAL", "MEAN", "NONE"):
        show(box, mode)
        assert box.data.color_attributes.active_color.name == "Mine"
    assert len(box.data.color_attributes) == 1


def test_stays_switchable_after_saving(tmp_path):
    box = add("Box", *CUBE)
    two_materials(box)
    before = slots(box)
    show(box, "MEAN")
    reopen(tmp_path)
    box = bpy.data.objects["Box"]
    assert box.discrete_fairing_inspection.mode == "MEAN"
    assert shown_materials(box) == {"Fairing Curvature"}
    show(box, "NONE")
    assert slots(box) == before and not box.modifiers and COLOUR not in box.data.attributes


def test_one_mesh_of_two_objects_keeps_its_colours_for_the_other():
    one = add("One", *CUBE)
    two = bpy.data.objects.new("Two", one.data)
    bpy.context.collection.objects.link(two)
    show(one, "MEAN")
    show(two, "MEAN")
    show(one, "NONE")
    assert COLOUR in two.data.attributes and shown_materials(one) == set()
    show(two, "NONE")
    assert COLOUR not in two.data.attributes


def test_smooth_while_inspected_is_not_the_mesh():
    box = add("Box", *CUBE)
    show(box, "ZEBRA")
    box.data.shade_flat()
    assert all(p.use_smooth for p in evaluated(box).polygons)
    bpy.context.scene.discrete_fairing_inspection.smooth = False
    assert not any(p.use_smooth for p in evaluated(box).polygons)


def test_flat_is_the_middle_colour_and_beyond_the_ends_nothing_changes():
    low, middle, high = colours.colours_of(np.array([-9.0, 0.0, 9.0]), (-1.0, 1.0), True)
    assert low[2] > low[0] and high[0] > high[2] and np.ptp(middle[:3]) < 0.1
    assert np.allclose(colours.colours_of(np.array([1.0]), (-1.0, 1.0), True)[0], high)
    values = np.append(np.linspace(-1.0, 1.0, 101), 100.0)  # one extreme
    low, high = colours.value_range(values, np.ones(102, bool), True)
    assert -low == high == pytest.approx(0.98, abs=0.01)
    assert colours.value_range(np.zeros(3), np.ones(3, bool), False) == (0.0, 1.0)


def test_what_is_measured_is_that_of_the_world():
    """A sphere of radius 1 in an object that is scaled by two, in a scene of centimetres."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=1.0)
    ball = bpy.context.object
    ball.scale = (2.0, 2.0, 2.0)
    bpy.context.scene.unit_settings.scale_length = 0.01
    assert display.value_text(bpy.context.scene, "MEAN", 0.5) == "50 /m"
    assert display.value_text(bpy.context.scene, "GAUSS", 0.25) == "2.5e+03 /m²"
    bpy.context.scene.unit_settings.system = "NONE"
    assert display.value_text(bpy.context.scene, "MEAN", 0.5) == "0.5"
    display.write_values(ball, "MEAN", bpy.context.scene.discrete_fairing_inspection)
    for name, expected in (("mean", 0.5), ("gauss", 0.25), ("total", 0.5)):
        found = [value.value for value in ball.data.attributes[f"fair_{name}_curvature"].data]
        assert np.median(found) == pytest.approx(expected, rel=0.04), name
