# SPDX-License-Identifier: GPL-3.0-or-later
"""A faired object remembers its source and settings, and is computed again in place."""

import bpy
import numpy as np
import pytest
from fake_layout import draw
from scenes import CUBE, activate, add, fair, positions

from addon.memory import recall
from addon.ui import main


def recompute():
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}


def raise_vertex(source, index=0, by=0.5):
    source.data.vertices[index].co.z += by
    source.data.update()


def test_source_and_settings_are_remembered():
    source = add("Box", *CUBE)
    result = fair(levels=2, metric_exponent=0.25, boundary="FREE")
    memory = result.discrete_fairing
    assert memory.source == source
    assert (memory.levels, memory.boundary) == (
        2,
        "FREE",
    ) and memory.metric_exponent == pytest.approx(0.25)


def test_recompute_follows_the_source():
    source = add("Box", *CUBE)
    result = fair(levels=2)
    before = positions(result.data)
    raise_vertex(source)
    recompute()
    assert bpy.context.active_object == result
    after = positions(result.data)
    assert np.array_equal(after[:8], positions(source.data)) and not np.array_equal(after, before)
    assert np.array_equal(after, positions(fresh(source, levels=2).data)), "as if it were made anew"


def fresh(source, **settings):
    source.hide_set(False)
    activate(source)
    return fair(**settings)


def test_recompute_with_other_settings():
    add("Box", *CUBE)
    result = fair(levels=1)
    result.discrete_fairing.levels = 3
    recompute()
    assert len(result.data.polygons) == 6 * 4**3
    assert recall(result, "report")["levels"][-1]["level"] == 3


def test_what_was_put_on_it_stays():
    add("Box", *CUBE)
    result = fair(levels=1)
    paint = bpy.data.materials.new("Paint")
    result.data.materials.append(paint)
    result.modifiers.new("Thick", "SOLIDIFY").thickness = 0.125
    result.location = (1, 2, 3)
    name, meshes = result.data.name, len(bpy.data.meshes)
    recompute()
    assert list(result.data.materials) == [paint]
    assert result.modifiers["Thick"].thickness == 0.125 and tuple(result.location) == (1, 2, 3)
    assert result.data.name == name and len(bpy.data.meshes) == meshes


def test_linked_duplicates_follow():
    source = add("Box", *CUBE)
    result = fair(levels=1)
    twin = result.copy()
    bpy.context.collection.objects.link(twin)
    raise_vertex(source)
    recompute()
    assert twin.data == result.data


def test_several_at_once():
    sources = [add("Box", *CUBE), add("Crate", *CUBE)]
    for source in sources:
        source.select_set(True)
    fair(levels=1)
    results = [bpy.data.objects[f"{source.name} Fair"] for source in sources]
    for source in sources:
        raise_vertex(source)
    recompute()
    for source, result in zip(sources, results):
        assert np.array_equal(positions(result.data)[:8], positions(source.data))


def test_a_failure_leaves_the_surface():
    source = add("Box", *CUBE)
    result = fair(levels=1, repair="REFUSE")
    before = positions(result.data)
    source.data.vertices[0].co = source.data.vertices[1].co  # a face collapses
    with pytest.raises(RuntimeError, match="Box"):
        bpy.ops.object.fairing_recompute()
    assert np.array_equal(positions(result.data), before)


def test_without_its_source_it_is_a_mesh_like_any_other():
    source = add("Box", *CUBE)
    result = fair(levels=1)
    bpy.data.objects.remove(source)
    assert result.discrete_fairing.source is None
    assert not bpy.ops.object.fairing_recompute.poll()
    assert "object.fairing_surface" in draw(main.VIEW3D_PT_fairing)
    assert not bpy.ops.object.fairing_show_source.poll()


def test_panel_shows_what_is_remembered():
    source = add("Box", *CUBE)
    bpy.context.scene.discrete_fairing.interpolation = "APPROXIMATE"
    assert "tolerance" in draw(main.VIEW3D_PT_fairing)
    fair(levels=1)
    log = draw(main.VIEW3D_PT_fairing)
    assert "object.fairing_recompute" in log and "object.fairing_surface" not in log
    assert "source" in log and "tolerance" not in log, "its own settings, not the scene's"
    assert "48 triangles" in log, "counted from its source"
    assert bpy.ops.object.fairing_show_source() == {"FINISHED"}
    assert bpy.context.active_object == source and source.visible_get()
    assert "object.fairing_surface" in draw(main.VIEW3D_PT_fairing)


def test_survives_saving(tmp_path):
    add("Box", *CUBE)
    fair(levels=1)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    result = bpy.data.objects["Box Fair"]
    assert (
        result.discrete_fairing.source == bpy.data.objects["Box"]
        and result.discrete_fairing.levels == 1
    )
    raise_vertex(bpy.data.objects["Box"])
    activate(result)
    recompute()
    assert np.array_equal(positions(result.data)[:8], positions(bpy.data.objects["Box"].data))
