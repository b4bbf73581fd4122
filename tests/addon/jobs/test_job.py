# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator from end to end: the new object gets the data of the source."""

import bpy
import numpy as np
import pytest
from scenes import (
    CUBE,
    add,
    add_suzanne,
    again,
    computed,
    exclude,
    fair,
    positions,
    recompute,
    settings,
)

from addon.choices import ENERGIES
from addon.jobs.fair import Job
from addon.mesh.modifiers import inspection_modifier


def test_shape_keys_are_faired_too(source):
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Twice").data.foreach_set("co", 2.0 * positions(source.data).ravel())
    source.data.shape_keys.key_blocks["Twice"].value = 0.5
    result = fair(levels=2)
    keys = result.data.shape_keys.key_blocks
    assert keys["Twice"].value == 0.5
    twice = np.array([point.co for point in keys["Twice"].data])
    # faired, not interpolated
    assert np.allclose(twice, 2.0 * positions(result.data), atol=1e-5)
    assert again(source, levels=2, use_shape_keys=False).data.shape_keys is None
    source.data.shape_keys.key_blocks["Twice"].data[0].co.z += 1.0
    recompute(result)
    brought = result.data.shape_keys.key_blocks["Twice"].data[0].co.z
    assert brought == source.data.shape_keys.key_blocks["Twice"].data[0].co.z


@pytest.mark.parametrize("energy", [key for key, *_ in ENERGIES])
def test_a_symmetric_mesh_has_a_symmetric_surface_up_to_the_last_bit(energy):
    add_suzanne()
    points = positions(fair(levels=1, energy=energy).data)
    images = points * np.float32([-1, 1, 1])
    nearest = [np.abs(images - point).max(axis=1).min() for point in points]
    assert max(nearest) <= 2**-22, "its coordinates are below 2"


def test_modifiers_are_copied_on_request_only(source):
    source.modifiers.new("Thick", "SOLIDIFY").thickness = 0.25
    assert not fair(levels=1).modifiers
    result = again(source, levels=1, copy_modifiers=True)
    assert result.modifiers["Thick"].thickness == 0.25
    result.modifiers.remove(result.modifiers["Thick"])
    result.modifiers.new("Mine", "BEVEL")
    recompute()
    assert [m.name for m in result.modifiers] == ["Mine"], "as somebody has changed them since"


@pytest.mark.parametrize("mode", ["ZEBRA", "MEAN"])
def test_inspection_is_no_part_of_the_source(source, mode):
    bpy.ops.object.fairing_inspect(mode=mode)
    evaluated = fair(levels=1, mesh_source="EVALUATED")
    assert inspection_modifier(source) and not evaluated.data.materials
    assert inspection_modifier(again(source, levels=1, copy_modifiers=True)) is None


def test_a_source_that_is_deleted_meanwhile_is_noticed(source):
    job = computed(Job(bpy.context, source, settings()))
    assert job.is_writable()
    bpy.data.objects.remove(source)
    assert not job.is_writable()


@pytest.mark.parametrize("again", [False, True])
def test_undo_meanwhile_is_no_deletion(again):
    """As in a second window: old references are dead, but the objects are there."""
    bpy.context.preferences.edit.use_global_undo = True
    source = add("Box", *CUBE)
    target = fair(levels=1) if again else None
    bpy.ops.ed.undo_push(message="before")
    bpy.context.view_layer.objects.active.location.x += 1.0
    bpy.ops.ed.undo_push(message="after")
    job = computed(Job(bpy.context, source, settings(), target))
    bpy.ops.ed.undo()
    assert job.is_writable()
    result = job.write(bpy.context)
    assert result.name == "Box Fair" and len(result.data.polygons) == 6 * 4**3


def unlink(source):
    for collection in source.users_collection:
        collection.objects.unlink(source)


HIDING = {
    "eye": lambda source: source.hide_set(True),
    "disabled": lambda source: setattr(source, "hide_viewport", True),
    "excluded": exclude,
    "unlinked": unlink,
}


@pytest.mark.parametrize("way", HIDING)
def test_modifiers_run_wherever_the_source_is(source, way):
    source.modifiers.new("More", "ARRAY")
    target = fair(levels=1, mesh_source="EVALUATED", hide_source=False)
    HIDING[way](source)
    source.modifiers["More"].count = 3
    objects, scene = set(bpy.data.objects), set(bpy.context.scene.objects)
    bpy.ops.object.fairing_recompute()
    assert len(target.data.polygons) == 18 * 4
    assert set(bpy.data.objects) == objects and set(bpy.context.scene.objects) == scene
    assert source.visible_get() is False
