# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair for …: one click makes the surface for the purpose of a selection."""

import bpy
import numpy as np
import panel_meshes
import pytest
from fake_layout import draw
from mathutils import Matrix
from scenes import (
    CUBE,
    TRIANGLE,
    activate,
    add,
    add_ball,
    add_sheet,
    add_suzanne,
    fair,
    positions,
    refused,
    set_edge_attribute,
    shown,
)

from addon.purposes import EASED_FIRST, PURPOSES, job_of, name_of_purpose, preset_file
from addon.ui.main import VIEW3D_PT_fairing

SURFACES = [purpose for purpose, *_ in PURPOSES if preset_file(purpose)]


@pytest.mark.parametrize("purpose", SURFACES)
def test_each_makes_its_surface(purpose):
    source = add_suzanne() if purpose == "CHARACTER" else add("Box", *CUBE)
    assert bpy.ops.object.fairing_for(purpose=purpose) == {"FINISHED"}
    surface = bpy.context.active_object
    made = surface.discrete_fairing
    assert made.source == source
    assert made.energy == ("MINIMUM_VARIATION" if purpose == "HULL" else "THIN_PLATE")
    assert (made.interpolation == "LIMIT") == (purpose in {"CHARACTER", "PANEL"})
    if purpose in {"HULL", "MECHANICAL"}:  # without a tolerance vertices are held
        np.testing.assert_array_equal(positions(surface.data)[:8], positions(source.data))


def test_a_surface_that_is_there_gets_the_settings_and_is_made_again():
    add("Box", *CUBE)
    bpy.ops.object.fairing_surface(levels=1)
    surface, before = bpy.context.active_object, len(bpy.data.objects)
    assert bpy.ops.object.fairing_for(purpose="POINTS") == {"FINISHED"}
    assert len(bpy.data.objects) == before
    assert surface.discrete_fairing.interpolation == "EXACT"
    assert bpy.context.scene.discrete_fairing.interpolation == "AUTO"


def dome(x, y):
    return 0.55 * np.cos(1.2 * x) * np.cos(1.2 * y)


@pytest.mark.parametrize("seed", range(3))
def test_measured_points_lose_their_scatter(seed):
    even = np.linspace(-1, 1, 9)
    scatter = np.random.default_rng(seed).normal(0, 0.012, (9, 9))
    source = add_sheet("Dome", even, even, lambda x, y: dome(x, y) + scatter)
    points = positions(source.data)

    def off(surface):
        places = shown(surface)
        return np.sqrt(((places[:, 2] - dome(*places[:, :2].T)) ** 2).mean())

    near = off(fair(interpolation="APPROXIMATE", tolerance=0.1))
    assert any(str(line).endswith("vertices at the limit") for line in draw(VIEW3D_PT_fairing))
    source.hide_set(False)
    activate(source)
    assert bpy.ops.object.fairing_for(purpose="POINTS") == {"FINISHED"}
    assert off(bpy.context.active_object) < 0.7 * near
    np.testing.assert_array_equal(positions(source.data), points)
    assert source.data.shape_keys.key_blocks["Eased"].value == 1


def off(scan):
    return np.sqrt(((np.linalg.norm(positions(scan.data), axis=1) - 1) ** 2).mean())


def test_a_whole_scan_loses_its_noise_in_place():
    scan = add_ball("Scan", 5, noise=0.004)
    faces = len(scan.data.polygons)
    before = off(scan)
    chosen = [face.index for face in scan.data.polygons][:9]
    scan.data.polygons.foreach_set("hide", [face.index in chosen for face in scan.data.polygons])
    assert bpy.ops.object.fairing_for(purpose="SCAN_PATCH") == {"FINISHED"}
    assert bpy.context.mode == "OBJECT", "where it was pressed"
    assert [face.index for face in scan.data.polygons if face.hide] == chosen
    assert len(scan.data.polygons) == faces
    assert off(scan) < 0.25 * before


def test_a_refusal_is_a_sentence_and_leaves_the_mode():
    refused("Select a mesh object first", bpy.ops.object.fairing_for, purpose="HULL")
    add("Triangle", *TRIANGLE)
    refused("^Error: Triangle: Select more faces", bpy.ops.object.fairing_for, purpose="SCAN_PATCH")
    scan = add_ball("Scan", 3, noise=0.004)
    scan.shape_key_add(name="Basis")
    before = positions(scan.data)
    refused("Press Tab, select all", bpy.ops.object.fairing_in_place)
    np.testing.assert_array_equal(positions(scan.data), before)
    assert bpy.context.mode == "OBJECT"


@pytest.mark.parametrize("purpose", sorted(set(SURFACES) - EASED_FIRST))
def test_after_a_job_the_panel_shows_its_slider_and_the_rest_under_more(purpose):
    add("Box", *CUBE)
    surface = fair()  # by defaults it is of no job
    assert job_of(surface.discrete_fairing) == ""
    seen = draw(VIEW3D_PT_fairing)
    assert {"Fairness", "Vertices"} <= set(seen[: seen.index("object.fairing_recompute")])
    bpy.ops.object.fairing_for(purpose=purpose)
    made = bpy.context.active_object.discrete_fairing
    assert job_of(made) == purpose
    made.levels, made.tolerance, made.limit, made.joint = 2, 0.02, 0.5, "CURVATURE"
    assert job_of(made) == purpose, "what the panel offers leaves it the job"
    seen = draw(VIEW3D_PT_fairing)
    slider = {"CHARACTER": "limit", "PANEL": "limit"}.get(purpose, "tolerance")
    above = seen[: seen.index("object.fairing_recompute")]
    assert name_of_purpose(purpose) in above and "levels" in above
    assert [name for name in ("tolerance", "limit") if name in above] == [slider]
    assert not {"Fairness", "Vertices"} & set(above)
    assert {"Fairness", "Vertices"} <= set(seen[seen.index("More") :])
    made.metric_exponent = 0.125
    assert job_of(made) == "", "settings of one's own are no job"


@pytest.mark.parametrize(
    ("hull", "creases", "energy"),
    [
        (panel_meshes.tumblehome(), None, "MINIMUM_VARIATION"),
        (panel_meshes.kayak(), None, "THIN_PLATE"),
        (panel_meshes.hard_chine(), None, "MINIMUM_VARIATION"),
        (panel_meshes.hard_chine(), 3, "THIN_PLATE"),
    ],
    ids=["even", "long faces", "chine", "chine that ends inside"],
)
def test_a_hull_has_flow_lines_where_they_do_not_swing(hull, creases, energy):
    source = add("Hull", hull.vertices.tolist(), hull.faces)
    set_edge_attribute(source.data, "crease_edge", "FLOAT", hull.crease_edges[:creases], 1.0)
    assert bpy.ops.object.fairing_for(purpose="HULL") == {"FINISHED"}
    surface = bpy.context.active_object
    assert surface.discrete_fairing.energy == energy
    low, high = positions(source.data), positions(surface.data)
    assert (high.max(axis=0) - low.max(axis=0)).max() < 0.01 * np.ptp(low, axis=0).max()
    surface.discrete_fairing.energy = "TOTAL_CURVATURE"
    assert bpy.ops.object.fairing_for(purpose="HULL") == {"FINISHED"}
    assert surface.discrete_fairing.energy == energy, "on a surface, its source decides"


def test_a_closed_body_with_flat_ends_keeps_its_thickness(capfd):
    """Flow Lines made a rudder three times as thick, Bending without sharp caps 1.13 times."""
    foil = [(0, 0), (0.06, 0.055), (0.3, 0.08), (0.7, 0.04), (1, 0.004)]
    foil += [(x, -y) for x, y in foil[:0:-1]]
    chords = ((0, 0.42), (0.3, 0.5), (0.7, 0.55), (1.1, 0.55), (1.4, 0.5))
    points = [(x * c, y * c, z) for z, c in chords for x, y in foil]
    sides = [(9 * r, k, (k + 1) % 9) for r in range(4) for k in range(9)]
    faces = [(r + j, r + k, r + 9 + k, r + 9 + j) for r, k, j in sides]
    source = add("Rudder", points, [*faces, tuple(range(9)), tuple(range(44, 35, -1))])
    assert bpy.ops.object.fairing_for(purpose="HULL") == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Bending in place of Flow Lines for Rudder: it is closed, with flat ends" in said
    thick, before = (np.ptp(positions(o.data)[:, 1]) for o in (bpy.context.object, source))
    assert thick < 1.05 * before


def test_half_a_panel_with_a_mirror_modifier_gives_the_whole(capfd):
    rows = np.linspace(0.0, 1.0, 5)
    half = add_sheet("Bonnet", rows, rows, lambda x, y: 0.2 - 0.1 * x**2 - 0.2 * y**2)
    half.modifiers.new("Mirror", "MIRROR").use_axis = (False, True, False)
    assert bpy.ops.object.fairing_for(purpose="PANEL") == {"FINISHED"}
    surface = bpy.context.active_object
    there = positions(surface.data)
    assert there[:, 1].min() == -there[:, 1].max() and there[:, 1].max() > 0.9
    middle = [v.normal.y for v in surface.data.vertices if abs(v.co.y) < 1e-7]
    assert len(middle) == 4 * 8 + 1 and np.abs(middle).max() < 1e-6, "smooth across the middle"
    assert job_of(surface.discrete_fairing) == "PANEL"
    assert "Mirror" in capfd.readouterr().out
    half.hide_set(False)
    activate(half)
    bpy.context.scene.discrete_fairing.symmetry_plane = "Y"
    assert bpy.ops.object.fairing_for(purpose="PANEL") == {"FINISHED"}
    assert positions(bpy.context.active_object.data)[:, 1].min() == 0.0
    assert "turn on Copy Modifiers" in capfd.readouterr().out


def test_half_a_cage_under_mirror_and_subdivision_surface_gives_the_whole():
    """The commonest stack: the surface takes the place of Subdivision Surface, and gets the Mirror modifier."""
    along, across = np.linspace(0.0, 1.0, 4), np.linspace(-1.0, 1.0, 5)
    half = add_sheet("Half", along, across, lambda x, y: 0.5 - 0.3 * x**2 - 0.2 * y**2)
    half.modifiers.new("Mirror", "MIRROR")
    half.modifiers.new("Subdivision", "SUBSURF")
    assert bpy.ops.object.fairing_for(purpose="CHARACTER") == {"FINISHED"}
    surface = bpy.context.active_object
    assert [m.type for m in surface.modifiers] == ["MIRROR"]
    assert job_of(surface.discrete_fairing) == "CHARACTER"
    shown = surface.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    assert positions(shown)[:, 0].min() == -positions(shown)[:, 0].max()
    middle = [v.normal.x for v in shown.vertices if v.co.x == 0.0]
    assert len(middle) == 4 * 8 + 1 and np.abs(middle).max() < 1e-6, "smooth across the middle"
    assert bpy.context.scene.discrete_fairing.symmetry_plane == "NONE", "the next mesh may be whole"


def test_a_mirror_beside_the_mesh_is_left_out(capfd):
    wheel = add("Wheel", *CUBE)
    wheel.data.transform(Matrix.Translation((3.0, 0.0, 0.0)))
    wheel.modifiers.new("Mirror", "MIRROR")
    wheel.modifiers.new("Subdivision", "SUBSURF")
    assert bpy.ops.object.fairing_for(purpose="CHARACTER") == {"FINISHED"}
    assert bpy.context.active_object.discrete_fairing.symmetry_plane == "NONE"
    assert "without Mirror" in capfd.readouterr().out


def test_a_job_takes_selected_meshes_beside_another_active_object():
    box = add("Box", *CUBE)
    bpy.ops.object.light_add()
    box.select_set(True)
    assert bpy.context.active_object.type == "LIGHT"
    assert bpy.ops.object.fairing_for(purpose="MECHANICAL") == {"FINISHED"}
    assert bpy.context.active_object.discrete_fairing.source == box


@pytest.mark.parametrize(
    "purpose, how",
    [
        *((purpose, "INVOKE_DEFAULT") for purpose, *_ in PURPOSES),
        ("HULL", "EXEC_DEFAULT"),
        ("SCAN_PATCH", "EXEC_DEFAULT"),
    ],
)
def test_undo_takes_the_surface_and_nothing_before_it(purpose, how):
    """The operator is called as by a button, with a step of undo of its own."""
    bpy.context.preferences.edit.use_global_undo = True
    scan = add_ball("Scan", 3, noise=0.004)
    bpy.ops.ed.undo_push(message="there")
    scan.location.x = 5.0
    bpy.ops.ed.undo_push(message="moved")
    before, points = len(bpy.data.objects), positions(scan.data)
    bpy.context.scene.discrete_fairing.levels = 1
    assert bpy.ops.object.fairing_for(how, True, purpose=purpose) == {"FINISHED"}
    bpy.ops.ed.undo()
    (scan,) = bpy.data.objects
    assert scan.location.x == 5.0 and len(bpy.data.objects) == before
    assert np.array_equal(positions(scan.data), points)
