# SPDX-License-Identifier: GPL-3.0-or-later
"""Strain in Blender: measured of a source, shown, selected, jumped to, written as a table."""

import csv

import bmesh
import bpy
import discrete_fairing
import numpy as np
import pytest
from dunes import FACES, OFF, WRONG, add_dune, dune
from fake_layout import draw
from scenes import CUBE, add, again, computed, fair, refused, settings, snapshot, to_object_mode

from addon.mesh.shape_keys import EASED
from addon.strain import cache
from addon.strain.measure import StrainJob
from addon.ui.inspect import VIEW3D_PT_fairing_strain


def measured(source, **options):
    return computed(StrainJob(bpy.context, source, **options)).result


def selected(source):
    assert bpy.context.mode == "EDIT_MESH"
    return [v.index for v in bmesh.from_edit_mesh(source.data).verts if v.select]


def test_strain_is_that_of_the_package():
    source = add_dune()
    it = measured(source)
    there = discrete_fairing.strain(dune(), FACES, boundary="curve", corner_vertices=[0, 6, 56, 62])
    assert np.allclose(it.lengths, there.excess, rtol=1e-4, atol=1e-6, equal_nan=True)
    assert it.floor == pytest.approx(there.floor, rel=1e-4)
    assert it.worst(1).tolist() == [WRONG] and it.lengths[WRONG] == pytest.approx(-OFF, rel=0.15)
    assert np.count_nonzero(np.abs(there.lengths) > 0.4 * OFF) > 4
    assert it.wrong.tolist() == [WRONG], "though its neighbours strain half as much"
    assert np.count_nonzero(np.abs(it.lengths) > 0.2 * OFF) == 1
    assert it.edge_length == pytest.approx(1.0, rel=0.05)
    # any settings of the panel will do
    settings(energy="MINIMUM_VARIATION", pad_size=0.0, use_selection=True, tension=0.5)
    for interpolation in ("LIMIT", "APPROXIMATE"):
        settings(interpolation=interpolation, tolerance=0.1)
        assert measured(source).worst(1).tolist() == [WRONG]


def test_lengths_are_those_in_the_world_and_ways_those_of_the_object():
    plain = measured(add_dune())
    large = add_dune()
    large.scale = (2.0, 2.0, 2.0)
    large.rotation_euler.x = 1.0
    bpy.context.view_layer.update()
    it = measured(large)
    assert it.lengths[WRONG] == pytest.approx(2.0 * plain.lengths[WRONG], rel=1e-4)
    assert it.directions[WRONG] == pytest.approx(plain.directions[WRONG], rel=1e-3, abs=1e-5)


def test_edits_of_edit_mode_and_sliders_count():
    source = add_dune(off=0.0)
    bpy.ops.object.mode_set(mode="EDIT")
    edited = bmesh.from_edit_mesh(source.data)
    edited.verts.ensure_lookup_table()
    edited.verts[24].co.z += 0.2
    assert measured(source).worst(1).tolist() == [24]
    to_object_mode()
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Right").data[24].co.z -= 0.2
    assert measured(source).lengths[24] == pytest.approx(-0.2, rel=0.15)
    source.data.shape_keys.key_blocks["Right"].value = 1.0
    assert abs(measured(source).lengths[24]) < 0.03
    assert measured(source, as_mixed=False).lengths[24] == pytest.approx(-0.2, rel=0.15)
    group = source.vertex_groups.new(name="Half")
    group.add([24], 0.5, "REPLACE")
    source.data.shape_keys.key_blocks["Right"].vertex_group = "Half"
    assert measured(source).lengths[24] == pytest.approx(-0.1, rel=0.2)


def test_borders_and_creases_are_those_of_the_surface():
    source = add_dune()
    fair(levels=1, boundary="LINEAR", hide_source=False)
    assert np.isnan(measured(source).lengths[3]), "straight borders stay"
    again(source, levels=1, symmetry_plane="X", hide_source=False)
    last = measured(source).lengths[3]
    assert not np.isnan(last), "of several surfaces the last one counts"
    for name in ("Dune Fair", "Dune Fair.001"):
        bpy.data.objects.remove(bpy.data.objects[name])
    alone = measured(source).lengths[3]
    assert not np.isnan(alone) and alone != last, "the border's own curve"


def test_nothing_is_computed_twice(monkeypatch):
    source = add_dune()
    job = cache.job_for(bpy.context, source)
    assert job.predicted_seconds > 0.0
    job.compute()
    cache.keep(job)
    again = cache.job_for(bpy.context, source)
    assert again.result is job.result and again.predicted_seconds == 0.0
    source.location.x = 5.0
    assert cache.job_for(bpy.context, source).result is not None, "the place does not matter"
    source.data.vertices[10].co.z += 0.1
    assert cache.job_for(bpy.context, source).result is None
    bpy.context.scene.discrete_fairing.metric_exponent = 0.0
    assert cache.job_for(bpy.context, source).result is None


def test_selects_the_wrong_one_or_the_worst():
    source = add_dune()
    before = snapshot(source)
    assert bpy.ops.object.fairing_select_strained() == {"FINISHED"}
    assert selected(source) == [WRONG]
    assert bpy.ops.object.fairing_select_strained(by="COUNT", count=4) == {"FINISHED"}
    found = cache.found_of(source)
    assert selected(source) == sorted(found.worst(4).tolist())
    to_object_mode()
    after = snapshot(source)
    for name in ("position", ".edge_verts", ".corner_vert"):
        assert after[0][name] == before[0][name]


def test_a_click_goes_to_the_vertex():
    source = add_dune()
    assert bpy.ops.object.fairing_go_to_strained(vertex=24) == {"FINISHED"}
    assert selected(source) == [24]
    refused("has no vertex 63", bpy.ops.object.fairing_go_to_strained, vertex=63)


def test_the_table_has_places_in_the_world_and_the_eased_ones(tmp_path):
    source = add_dune()
    source.location.z = 10.0
    path = tmp_path / "offsets.csv"
    assert bpy.ops.object.fairing_strain_table(filepath=str(path)) == {"FINISHED"}
    head, *rows = csv.reader(path.read_text().splitlines())
    assert head == ["vertex", "x", "y", "z", "strain"] and len(rows) == 63
    places = np.array([row[1:4] for row in rows], float)
    assert np.allclose(places, dune() + [0.0, 0.0, 10.0], atol=1e-5)
    assert float(rows[WRONG][4]) == pytest.approx(-OFF, rel=0.15) and rows[0][4] == ""
    source.shape_key_add(name="Basis")
    key = source.shape_key_add(name=EASED)
    key.data[WRONG].co.z -= OFF
    key.value = 1.0
    bpy.ops.object.fairing_strain_table(filepath=str(path))
    head, *rows = csv.reader(path.read_text().splitlines())
    moves = np.array([row[7] for row in rows], float)
    assert moves[WRONG] == pytest.approx(OFF, rel=1e-4) and np.delete(moves, WRONG).max() == 0.0
    # before, whatever the slider says
    assert float(rows[WRONG][8]) == pytest.approx(-OFF, rel=0.15)
    refused("cannot be written", bpy.ops.object.fairing_strain_table, filepath=str(tmp_path))
    refused("Choose a file", bpy.ops.object.fairing_strain_table)


def test_the_panel_lists_the_worst():
    source = add_dune()
    bpy.ops.object.fairing_select_strained()
    to_object_mode()
    for show in (True, False):
        assert bpy.ops.object.fairing_strain() == {"FINISHED"}
        assert source.discrete_fairing_strain.show is show
        assert list(cache.shown_sources) == ([source] if show else [])
    source.discrete_fairing_strain.show = True
    log = draw(VIEW3D_PT_fairing_strain)
    assert log.count("object.fairing_go_to_strained") == 10
    assert f"Outliers: 1 of {len(cache.found_of(source).held)}" in log
    assert any("inwards" in line for line in log)


def test_why_there_is_no_strain_is_said():
    add("Lines", *([(0, 0, 0), (1, 0, 0)], []), edges=[(0, 1)])
    refused("Lines: ", bpy.ops.object.fairing_select_strained)
    closed = add("Box", *CUBE)
    assert len(measured(closed).held) == 8
