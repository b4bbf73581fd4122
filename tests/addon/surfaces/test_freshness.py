# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface says that it is out of date: its source or its settings have changed since."""

import bpy
import numpy as np
import pytest
from fake_layout import draw
from live_scenes import follow, live, move, pull
from scenes import (
    CUBE,
    activate,
    add,
    again,
    edit,
    fair,
    positions,
    recompute,
    reopen,
    to_object_mode,
)

from addon.mesh.marks import BOUNDARY, NORMAL
from addon.surfaces.freshness import SETTINGS_CHANGED, SOURCE_CHANGED, stale_surfaces, why_stale
from addon.ui import main


def badges():
    return [line for line in draw(main.VIEW3D_PT_fairing) if "out of date" in line.lower()]


def test_a_source_that_has_changed(source):
    target = fair(levels=1)
    assert why_stale(target) == "" and not badges()
    pull(source)
    assert why_stale(target) == SOURCE_CHANGED
    assert badges() == ["Out of date: source changed"]
    pull(source, by=-0.5)
    assert why_stale(target) == "", "changed back"
    pull(source)
    recompute()
    assert why_stale(target) == "" and not badges()


def crease(source):
    source.data.attributes.new("crease_edge", "FLOAT", "EDGE").data[0].value = 1.0
    source.data.update()


def add_key(source):
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Smile").data[0].co.z += 1.0


def mark_edge(source):
    source.data.attributes.new(BOUNDARY.name, "INT", "EDGE").data[0].value = 2
    source.data.update()


def fix_normal(source):
    source.data.attributes.new(NORMAL.name, "FLOAT_VECTOR", "POINT").data[0].vector = (0, 0, 1)
    source.data.update()


def scale(source):
    source.scale.x = 2.0


def edit_mode(source):
    bpy.ops.object.fairing_show_source()
    edit(source, "FACE", range(6))
    bpy.ops.mesh.subdivide()


@pytest.mark.parametrize("way", [crease, add_key, mark_edge, fix_normal, scale, edit_mode])
def test_what_else_counts(source, way):
    target = fair(levels=1)
    way(source)
    source.update_tag()
    follow()
    assert why_stale(target) == SOURCE_CHANGED


def test_what_does_not_count(source):
    target = fair(levels=1)
    source.data.materials.append(bpy.data.materials.new("Paint"))
    target.discrete_fairing.hide_source = False
    bpy.ops.object.fairing_show_source()
    bpy.ops.object.mode_set(mode="EDIT")
    to_object_mode()
    follow()
    assert why_stale(target) == ""


def test_modifiers_count_where_they_are_faired(source):
    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 1
    plain, whole = fair(levels=1), again(source, levels=1, mesh_source="EVALUATED")
    modifier.levels = 2
    source.update_tag()
    follow()
    assert why_stale(plain) == "" and why_stale(whole) == SOURCE_CHANGED


def test_settings_that_have_changed():
    add("Box", *CUBE)
    target = fair(levels=1)
    target.discrete_fairing.tension = 0.5
    assert why_stale(target) == SETTINGS_CHANGED and badges()
    target.discrete_fairing.tension = 0.0
    assert why_stale(target) == ""


def test_all_of_a_file_are_recomputed(tmp_path):
    sources = [add("Box", *CUBE), add("Crate", *CUBE), add("Case", *CUBE)]
    targets = []
    for source in sources:
        activate(source)
        targets.append(fair(levels=1))
    for source in sources[:2]:
        move(source)
    reopen(tmp_path)
    assert sorted(t.name for t in stale_surfaces()) == ["Box Fair", "Crate Fair"], "after loading"
    activate(bpy.data.objects["Box"])
    assert badges()[0] == "Box Fair is out of date"
    assert bpy.ops.object.fairing_recompute_stale() == {"FINISHED"}
    assert list(stale_surfaces()) == [] and not bpy.ops.object.fairing_recompute_stale.poll()
    for name in ("Box", "Crate"):
        mesh = bpy.data.objects[f"{name} Fair"].data
        assert np.array_equal(positions(mesh)[:8], positions(bpy.data.objects[name].data))


def test_a_live_surface_has_no_badge(source):
    target = fair(levels=1)
    live(target)
    pull(source)
    activate(target)
    assert not badges()
    target.discrete_fairing_live.on = False
    assert why_stale(target) == ""
