# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Border and Check Joints as a stylist uses them."""

import bpy
import numpy as np
import pytest
from fake_layout import draw
from live_scenes import follow, pull
from mathutils import Vector
from scenes import activate, add_sheet, fair, positions, recompute, refused, to_object_mode

from addon import core
from addon.check import joints
from addon.live import pace, registry
from addon.operators import modal as redo
from addon.operators.fair import Fairing
from addon.surfaces import neighbours
from addon.surfaces.freshness import NEIGHBOUR_CHANGED, NEIGHBOUR_MOVED, UNFINISHED, why_stale
from addon.ui import inspect as check_panel
from addon.ui.main import VIEW3D_PT_fairing


def strip(name, first, last, height):
    """A sheet of 4 x 3 faces between y = first and y = last."""
    along, across = np.linspace(0, 1.4, 5), np.linspace(first, last, 4)
    return add_sheet(name, along, across, lambda x, y: height(y) + 0.1 * np.sin(2 * x))


@pytest.fixture
def panels():
    strip("Bonnet", 0, 1.2, lambda y: 0.3 - 0.2 * y * y)
    bonnet = fair(levels=3)
    strip("Fender", 1.2, 2, lambda y: 0.012 - 0.9 * (y - 1.2))
    return bonnet, fair(levels=3)


def check(*objects):
    activate(*objects)
    assert bpy.ops.object.fairing_joints() == {"FINISHED"}
    (row,) = joints.rows()
    return row


def match(*panels, **options):
    activate(*panels)
    assert bpy.ops.object.fairing_match_border(**options) == {"FINISHED"}


def test_two_panels_meet_without_a_kink(panels):
    bonnet, fender = panels
    fender.location = bonnet.location = (3, 2, 1)
    assert np.degrees(check(*panels).kink) > 3
    match(*panels)
    row = check(*panels)
    assert np.degrees(row.kink) < 0.05 and row.gap == 0.0
    assert fender.discrete_fairing.neighbour == bonnet
    assert why_stale(fender) == ""


def test_curvature_too_and_again_by_recompute(panels):
    bonnet, fender = panels
    match(*panels, joint="CURVATURE")
    assert np.degrees(check(*panels).kink) < 0.05
    meshes = [neighbours.shown(bpy.context, panel) for panel in (fender, bonnet)]
    assert core.module().joint(*meshes).jump.max() < 0.03
    made = positions(fender.data)
    recompute(fender)
    assert np.array_equal(positions(fender.data), made)
    fender.discrete_fairing.neighbour = None
    assert why_stale(fender) == "Settings changed"
    recompute()
    assert np.degrees(check(*panels).kink) > 3


def matched_live(bonnet, fender):
    """The live session of the fender, whose border meets the bonnet's."""
    match(bonnet, fender)
    activate(fender)
    assert bpy.ops.object.fairing_live() == {"FINISHED"}
    (session,) = registry.sessions()
    session.follow()
    return session


def test_live_follows_the_neighbour(panels):
    bonnet, fender = panels
    session = matched_live(*panels)
    assert not session.needs_look()
    rotated(bonnet, 10)
    assert np.degrees(check(*panels).kink) > 3
    assert session.needs_look() and session.follow()  # as the timer does
    assert not session.needs_look()
    assert np.degrees(check(*panels).kink) < 0.1
    bpy.ops.object.fairing_live()
    assert why_stale(fender) == ""


def test_live_is_not_lowered_to_a_level_that_meets_no_neighbour(panels, monkeypatch):
    """Level 1 was refused, and Live stopped following where updates were slow."""
    session = matched_live(*panels)
    monkeypatch.setattr(pace, "SLOW", 0.0)
    for _ in range(3 * pace.IN_A_ROW):
        pull(panels[1].discrete_fairing.source, 10, 0.01)
    assert not session.trouble and session.level == 2


def rotated(bonnet, angle):
    """About the joint with the fender, which is straight in x and y only: so its mesh turns."""
    for vertex in bonnet.data.vertices:
        vertex.co.z += np.tan(np.radians(angle)) * (vertex.co.y - 1.2)
    bonnet.data.update()
    bpy.context.view_layer.update()


def test_a_neighbour_that_moves_or_changes_leaves_the_surface_out_of_date(panels):
    bonnet, fender = panels
    match(*panels)
    assert why_stale(fender) == ""
    bonnet.location.z += 0.01
    follow()
    assert why_stale(fender) == NEIGHBOUR_MOVED
    recompute(fender)
    assert why_stale(fender) == ""
    pull(bonnet, 0, 0.1)
    assert why_stale(fender) == NEIGHBOUR_CHANGED


def test_both_change_and_are_recomputed(panels):
    """In either order, without end: each is given the other as it is alone."""
    before = [positions(panel.data) for panel in panels]
    match(*panels, both=True)
    made = [positions(panel.data) for panel in panels]
    assert all(np.abs(a - b).max() > 1e-3 for a, b in zip(before, made))
    assert np.degrees(check(*panels).kink) < 0.05
    assert [panel.discrete_fairing.neighbour for panel in panels] == list(panels[::-1])
    activate(panels[0])
    assert "Both change, each by half" in draw(VIEW3D_PT_fairing)
    for panel in panels:
        recompute(panel)
    assert all(np.array_equal(positions(panel.data), was) for panel, was in zip(panels, made))
    assert [why_stale(panel) for panel in panels] == ["", ""]


def test_one_of_both_that_changes_leaves_both_out_of_date(panels):
    bonnet, fender = panels
    match(*panels, both=True, joint="CURVATURE")
    pull(bonnet.discrete_fairing.source, 5, 0.05)
    assert (why_stale(bonnet), why_stale(fender)) == ("Source changed", NEIGHBOUR_CHANGED)
    recompute(fender)
    assert why_stale(fender) == ""
    recompute(bonnet)
    assert (why_stale(bonnet), why_stale(fender)) == ("", "")
    assert np.degrees(check(*panels).kink) < 0.05
    bonnet.discrete_fairing.levels = 4
    assert (why_stale(bonnet), why_stale(fender)) == ("Settings changed", NEIGHBOUR_CHANGED)
    recompute(bonnet)
    assert (why_stale(bonnet), why_stale(fender)) == ("", NEIGHBOUR_CHANGED)
    recompute(fender)
    assert (why_stale(bonnet), why_stale(fender)) == ("", "")


def test_only_faired_surfaces_both_change_and_one_that_takes_all_ends_it(panels):
    bonnet, fender = panels
    plain = strip("Plain", 1.2, 2, lambda y: 0.012 - 0.9 * (y - 1.2))
    activate(plain, fender)
    with pytest.raises(RuntimeError, match="only faired surfaces can both change"):
        bpy.ops.object.fairing_match_border(both=True)
    match(*panels, both=True)
    match(*panels)
    taking = bpy.context.active_object
    giving = bonnet if taking == fender else fender
    assert taking.discrete_fairing.neighbour == giving
    assert giving.discrete_fairing.neighbour is None


def test_a_border_matched_with_fewer_levels_knows_its_neighbour(panels, monkeypatch):
    """As Adjust Last Operation does where the whole surface takes too long."""
    bonnet, fender = panels
    monkeypatch.setattr(Fairing, "is_redone", lambda self: True)
    monkeypatch.setattr(Fairing, "_in_time", lambda self, context, jobs: None)
    monkeypatch.setattr(redo, "BUDGET", 1e-9)
    match(*panels)
    assert (fender.discrete_fairing.neighbour, fender.discrete_fairing.levels) == (bonnet, 3)
    assert why_stale(fender) == UNFINISHED and np.degrees(check(*panels).kink) < 1
    monkeypatch.undo()
    recompute(fender)
    assert np.degrees(check(*panels).kink) < 0.05


def test_of_a_surface_and_a_mesh_the_surface_changes_whichever_is_active(panels):
    _, fender = panels
    plain = strip("Plain", 0, 1.2, lambda y: 0.3 - 0.2 * y * y)
    activate(fender, plain)
    assert bpy.context.active_object == plain
    assert "object.fairing_match_border" in draw(VIEW3D_PT_fairing)
    before = positions(plain.data)
    assert bpy.ops.object.fairing_match_border() == {"FINISHED"}
    assert fender.discrete_fairing.neighbour == plain
    assert np.array_equal(positions(plain.data), before)
    activate(plain)
    refused("Select a faired surface", bpy.ops.object.fairing_match_border)


def test_the_worst_place_is_shown(panels):
    row = check(*panels)
    drawn = draw(check_panel.VIEW3D_PT_fairing_check)
    assert any(line.startswith(f"{np.degrees(row.kink):.2f}° kink") for line in drawn)
    assert "object.fairing_select_joint" in drawn
    assert bpy.ops.object.fairing_select_joint(index=0) == {"FINISHED"}
    target = row.first.find()
    assert target.mode == "EDIT"
    to_object_mode()
    assert [v.index for v in target.data.vertices if v.select] == [row.worst]


def shading_apart(first, other):
    """Degrees, the largest: between the normals that two meshes show at common vertices."""
    shown = []
    for panel in (first, other):
        normals = np.zeros((len(panel.data.vertices), 3))
        corners = [loop.vertex_index for loop in panel.data.loops]
        normals[corners] = [normal.vector for normal in panel.data.corner_normals]
        shown.append({tuple(np.round(v.co, 4)): n for v, n in zip(panel.data.vertices, normals)})
    common = shown[0].keys() & shown[1].keys()
    assert len(common) == 4 * 8 + 1
    turns = [np.cross(shown[0][at], shown[1][at]) for at in common]
    return np.degrees(np.linalg.norm(turns, axis=1).max())


@pytest.mark.parametrize("options", [{}, {"joint": "CURVATURE"}, {"both": True}])
def test_reflections_run_across_a_joint(panels, options):
    """Blender's normals at a border are those of the faces on one side, 0.9° off together."""
    bonnet, fender = panels
    match(*panels, **options)
    assert shading_apart(*panels) < 0.05
    for panel in panels:
        recompute(panel)
        assert shading_apart(*panels) < 0.05
    for panel in panels:
        panel.discrete_fairing.neighbour = None
    recompute(fender)
    assert not any(panel.data.has_custom_normals for panel in panels)
    assert shading_apart(*panels) > 0.5


def test_live_keeps_reflections_across_a_joint(panels):
    bonnet, fender = panels
    session = matched_live(*panels)
    pull(fender.discrete_fairing.source, 10, 0.05)
    assert shading_apart(*panels) < 0.2
    session.complete(bpy.context)
    assert shading_apart(*panels) < 0.05


def test_normals_of_the_user_stay(panels):
    bonnet, fender = panels
    own = np.tile([0.0, 0.0, 1.0], (len(bonnet.data.loops), 1))
    bonnet.data.normals_split_custom_set(own)
    match(*panels)
    shown = [normal.vector.z for normal in bonnet.data.corner_normals]
    assert min(shown) > 0.999 and fender.data.discrete_fairing.joint_normals


def test_a_crease_that_crosses_a_joint_keeps_its_normals(panels):
    """Each side of a crease has its own fan of faces."""
    bonnet, fender = panels
    for panel in panels:
        crease = panel.discrete_fairing.source.data
        layer = crease.attributes.new("crease_edge", "FLOAT", "EDGE")
        for edge, item in zip(crease.edges, layer.data):
            ends = [crease.vertices[i].co for i in edge.vertices]
            item.value = float(all(abs(co.x - 0.7) < 1e-5 for co in ends))
        for vertex in crease.vertices:
            vertex.co.z -= 0.4 * abs(vertex.co.x - 0.7)
        recompute(panel)
    match(*panels)
    normals = [normal.vector for normal in bonnet.data.corner_normals]
    on = [
        normals[loop.index]
        for loop in bonnet.data.loops
        if (bonnet.data.vertices[loop.vertex_index].co.xy - Vector((0.7, 1.2))).length < 1e-5
    ]
    assert len(on) == 2 and np.degrees(on[0].angle(on[1])) > 20
