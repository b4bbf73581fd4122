# SPDX-License-Identifier: GPL-3.0-or-later
"""A live surface follows its source: moved vertices, creases, settings, other topology, errors."""

import bmesh
import bpy
import numpy as np
import pytest
from live_scenes import follow, live, move, pull, session, through
from scenes import CUBE, add, add_suzanne, fair, positions, set_edge_attribute

from addon.live import handlers, pace


def test_it_takes_the_surface_that_is_there_and_shows_its_source(source):
    target = fair(levels=2)
    assert source.hide_get()
    assert bpy.ops.object.fairing_live() == {"FINISHED"}
    assert target.discrete_fairing_live.on and not source.hide_get()
    assert [o for o in bpy.data.objects if o.discrete_fairing.source] == [target]
    assert len(target.data.polygons) == 6 * 4**2, "no finer than the surface itself"


def test_moved_vertices_in_edit_mode(source):
    target = live(source)
    bpy.ops.object.mode_set(mode="EDIT")
    edit = bmesh.from_edit_mesh(source.data)
    edit.verts.ensure_lookup_table()
    for step in range(3):
        edit.verts[0].co.z -= 0.25
        bmesh.update_edit_mesh(source.data, loop_triangles=False, destructive=False)
        follow()
        assert positions(target.data)[0][2] == np.float32(-1.0 - 0.25 * (step + 1))
    assert source.mode == "EDIT" and session(target).updates == 4


def crease(source, _):
    rim = [(1, 3), (3, 7), (7, 5), (5, 1)]
    set_edge_attribute(source.data, "crease_edge", "FLOAT", rim, 1.0)
    source.data.update()


def turn_an_edge(source, _):
    """The mesh has as many vertices, edges and faces as before."""
    points, faces = positions(source.data).tolist(), [p.vertices[:] for p in source.data.polygons]
    source.data.clear_geometry()
    source.data.from_pydata(points, [], [*faces[:-2], (1, 5, 3), (5, 7, 3)])
    source.data.update()


CHANGES = {
    "moved": lambda source, _: move(source),
    "creased": crease,
    "another topology": turn_an_edge,
    "energy": lambda _, of: setattr(of, "energy", "TOTAL_CURVATURE"),
    "metric": lambda _, of: setattr(of, "metric_exponent", 1.0),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_changes_the_surface_and_what_does_not(change):
    faces = [*CUBE[1][:-1], (1, 5, 7), (1, 7, 3)]
    source = add("Box", [(x, y, 2 * z) for x, y, z in CUBE[0]], faces)
    target = live(source)
    before, mesh = positions(target.data), target.data
    for moved in (source, target):
        moved.location.x += 1.0
        source.data.update()
        follow()
    assert session(target).updates == 1 and "sharp_edge" not in mesh.attributes
    CHANGES[change](source, target.discrete_fairing)
    follow()
    handlers.on_timer()
    after = positions(target.data)
    assert after.shape == before.shape and not np.array_equal(after[8:], before[8:])
    assert through(target, source)
    if change == "moved":
        assert target.data == mesh, "the same mesh"
    if change == "creased":
        sharp = target.data.attributes["sharp_edge"].data
        assert sum(item.value for item in sharp) == 4 * 2**3


def test_live_levels(source):
    target = live(source)
    target.discrete_fairing_live.levels = 1
    target.update_tag()
    follow()
    assert len(target.data.polygons) == 6 * 4
    target.discrete_fairing_live.levels = 5
    handlers.on_timer()
    assert len(target.data.polygons) == 6 * 4**3, "no finer than the surface itself"


@pytest.mark.parametrize("hidden", ["", "hide_set", "hide_viewport"])
def test_with_modifiers_of_a_source_that_may_be_hidden(source, hidden):
    bpy.context.scene.discrete_fairing.mesh_source = "EVALUATED"
    modifier = source.modifiers.new("More", "ARRAY")
    target = live(source)
    if hidden == "hide_set":
        source.hide_set(True)
    elif hidden:
        source.hide_viewport = True
    modifier.count = 3
    follow()
    handlers.on_timer()
    assert not session(target).trouble
    assert len(target.data.polygons) == 18 * 4**3
    updates = session(target).updates
    for _ in range(3):
        follow()
        handlers.on_timer()
    assert session(target).updates == updates, "what stands in for the source is no edit"
    modifier.count = 2
    follow()
    bpy.ops.object.fairing_live()
    assert len(target.data.polygons) == 12 * 4**3, "the last edit too, without a timer"


def test_a_region_is_that_of_the_beginning(source):
    bpy.context.scene.discrete_fairing.use_selection = True
    for face in source.data.polygons:
        face.select = face.index in (0, 1)
    target = live(source)
    assert not target.discrete_fairing_live.status.count("face is selected")
    before = positions(target.data)
    for face in source.data.polygons:
        face.select = False
    pull(source)
    assert not np.array_equal(positions(target.data), before)
    bpy.ops.object.fairing_live()
    assert len(target.data.polygons) == 6 * 4**3


def test_an_error_leaves_the_last_surface_and_it_goes_on(source):
    bpy.context.scene.discrete_fairing.repair = "REFUSE"
    target = live(source)
    before = positions(target.data)
    source.data.clear_geometry()
    source.data.from_pydata(CUBE[0], [], [CUBE[1][0][::-1], *CUBE[1][1:]])
    source.data.update()
    follow()
    assert np.array_equal(positions(target.data), before)
    assert "against the neighbours" in target.discrete_fairing_live.status
    assert target.discrete_fairing_live.on
    assert not session(target).is_waiting, "no full level of what cannot be faired"
    source.data.clear_geometry()
    source.data.from_pydata(*CUBE[:1], [], CUBE[1])
    pull(source)
    assert not session(target).trouble
    assert through(target, source)


def test_what_cannot_be_faired_anew_is_said_with_the_full_level(source):
    """A face that collapses for a moment does not stop the edit, since charts are those of its beginning."""
    bpy.context.scene.discrete_fairing.repair = "REFUSE"
    target = live(source)
    source.data.vertices[0].co = source.data.vertices[1].co
    source.data.update()
    follow()
    assert not session(target).trouble
    assert through(target, source)
    session(target).complete(bpy.context)
    assert "another vertex of the same face" in target.discrete_fairing_live.status
    pull(source, by=-1.0)
    assert not session(target).trouble and session(target).is_waiting


def test_the_level_is_lowered_where_updates_are_slow(source, monkeypatch):
    target = live(source)
    monkeypatch.setattr(pace, "SLOW", 0.0)
    for _ in range(pace.IN_A_ROW + 1):
        pull(source)
    assert len(target.data.polygons) == 6 * 4**2
    assert "Level 2 instead of 3" in target.discrete_fairing_live.status


def test_thin_plate_stands_in_where_another_energy_is_hopeless():
    """Total curvature of Suzanne at this level takes seconds, and would stop the edit."""
    source = add_suzanne()
    bpy.context.scene.discrete_fairing.energy = "TOTAL_CURVATURE"
    bpy.context.scene.discrete_fairing.levels = 4
    target = live(source)
    target.discrete_fairing_live.levels = 4
    handlers.on_timer()
    assert "Bending while editing" in target.discrete_fairing_live.status
    assert target.discrete_fairing.energy == "TOTAL_CURVATURE" and not session(target).trouble
    assert session(target).made.solver.energy == "thin_plate"
