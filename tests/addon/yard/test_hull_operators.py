# SPDX-License-Identifier: GPL-3.0-or-later
"""Close Hull, Hydrostatics, Section Curves and the lines plan, on the example tables."""

import csv

import bpy
import numpy as np
import pytest
from scenes import CUBE, EXAMPLES, activate, add, edit, fair, positions, refused, to_object_mode

from addon.mesh.offset_names import read_names
from addon.operators.hull import in_metres
from addon.yard.hydrostatics import hydrostatics, solid

FILES = ("offsets_bulb.csv", "offsets_chine.csv", "offsets_yacht.tsv")


def imported(file):
    assert bpy.ops.import_mesh.fairing_offsets(filepath=str(EXAMPLES / file)) == {"FINISHED"}
    return bpy.context.active_object


def groups(path):
    """(code, value) pairs of a DXF file."""
    lines = path.read_text("ascii").splitlines()
    return list(zip(map(int, lines[::2]), lines[1::2], strict=True))


@pytest.mark.parametrize("file", FILES)
def test_one_click_closes_a_half_hull(file):
    half = imported(file)
    count = len(half.data.vertices)
    assert bpy.ops.object.fairing_close() == {"FINISHED"}
    closed = bpy.context.active_object
    assert closed != half and len(half.data.vertices) == count
    assert closed.visible_get() and not half.visible_get(), "one of two coincident hulls is shown"
    found = solid(*in_metres(bpy.context, closed))
    assert found.volume > 0 and abs(found.centroid[1]) < 1e-6
    points = positions(closed.data)
    middle = (points[:, 1] == 0).sum()
    assert len(points) == 2 * count - middle
    weights = closed.data.attributes["crease_edge"].data
    names = read_names(closed.data)
    sheer = [e for e in closed.data.edges if all(names[v].endswith("Sheer") for v in e.vertices)]
    along = [e for e in sheer if len({names[v] for v in e.vertices}) == 2]
    assert len(along) == 2 * (len({n for n in names if n.endswith("Sheer")}) - 1)
    assert all(weights[e.index].value == 1.0 for e in along)


def test_of_a_surface_the_closed_one_is_faired_alike():
    imported("offsets_chine.csv")
    surface = fair(levels=2, symmetry_plane="Y")
    before = positions(surface.data)
    assert bpy.ops.object.fairing_close() == {"FINISHED"}
    closed = bpy.context.active_object
    assert closed.discrete_fairing.source is not None and closed.discrete_fairing.levels == 2
    points, triangles = in_metres(bpy.context, closed)
    assert solid(points, triangles).volume > 0
    nearest = [np.linalg.norm(points - place, axis=1).min() for place in before[::7]]
    assert max(nearest) < 2e-3, "the hull is the half's, within 2 mm of 8 m"
    sharp = [e for e in closed.data.edges if e.use_edge_sharp]
    places = positions(closed.data)
    keel = [e for e in sharp if not places[list(e.vertices), 1].any()]
    assert len(keel) > 8 * 2**2, "keel and stem are sharp where both halves meet"
    transom = points[points[:, 0] > points[:, 0].max() - 1e-4]
    assert len(transom) > 50, "the transom is flat"


def test_what_is_no_half_hull_is_refused():
    add("Cube", *CUBE)
    refused("Cube is no half hull: it crosses the plane Y = 0", bpy.ops.object.fairing_close)
    add("Sheet", [(0, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)], [(0, 1, 2, 3)])
    with pytest.raises(RuntimeError, match="Sheet has 4 open edges below the waterplane"):
        bpy.ops.object.fairing_hydrostatics(draught=0.1)
    refused("no edge lies in the plane Y = 0", bpy.ops.object.fairing_close)
    half = imported("offsets_yacht.tsv")
    edit(half, "FACE", [33])
    bpy.ops.mesh.delete(type="FACE")
    to_object_mode()
    before = len(bpy.data.meshes)
    refused("4 open edges are at holes in its side", bpy.ops.object.fairing_close)
    assert len(bpy.data.meshes) == before


def test_hydrostatics_of_half_whole_and_closed_agree(tmp_path):
    half = imported("offsets_yacht.tsv")
    points, triangles = in_metres(bpy.context, half)
    bpy.context.scene.unit_settings.scale_length = 0.001
    small = in_metres(bpy.context, imported("offsets_yacht.tsv"))[0]
    assert np.ptp(small[:, 0]) == pytest.approx(10.0), "whatever the scene's unit"
    bpy.context.scene.unit_settings.scale_length = 1.0
    activate(half)
    low = points[:, 2].min()
    alone = hydrostatics(points, triangles, low + 0.4)
    bpy.ops.object.fairing_close()
    whole = hydrostatics(*in_metres(bpy.context, bpy.context.active_object), low + 0.4)
    assert whole.volume == pytest.approx(alone.volume, rel=1e-6)
    assert whole.waterplane == pytest.approx(alone.waterplane, rel=1e-6)
    assert bpy.ops.object.fairing_hydrostatics(draught=0.4) == {"FINISHED"}
    path = tmp_path / "h.csv"
    options = {"filepath": str(path), "draught": 0.4, "count": 4}
    assert bpy.ops.object.fairing_hydrostatics_table(**options) == {"FINISHED"}
    rows = list(csv.DictReader(path.open(newline="")))
    assert len(rows) == 4 and float(rows[-1]["volume_m3"]) == pytest.approx(whole.volume, rel=1e-6)
    assert float(rows[-1]["displacement_kg"]) == pytest.approx(1025 * whole.volume, rel=1e-6)


def test_without_a_draught_the_hull_floats_at_half_its_height(tmp_path, capfd):
    bpy.context.scene.unit_settings.scale_length = 0.001
    imported("offsets_yacht.tsv")
    bpy.ops.object.fairing_close()
    points, triangles = in_metres(bpy.context, bpy.context.active_object)
    low, height = points[:, 2].min(), np.ptp(points[:, 2])
    path = tmp_path / "h.csv"
    assert bpy.ops.object.fairing_hydrostatics_table(filepath=str(path)) == {"FINISHED"}
    rows = list(csv.DictReader(path.open(newline="")))
    assert float(rows[-1]["draught_m"]) == pytest.approx(0.5 * height)
    volume = hydrostatics(points, triangles, low + 0.5 * height).volume
    assert float(rows[-1]["volume_m3"]) == pytest.approx(volume)
    capfd.readouterr()
    bpy.ops.object.fairing_hydrostatics()
    assert "Turn the hull" not in capfd.readouterr().out
    bpy.context.active_object.rotation_euler.z = np.pi / 2
    bpy.ops.object.fairing_hydrostatics()
    assert "Turn the hull" in capfd.readouterr().out
    refused("Set Draught below", bpy.ops.object.fairing_hydrostatics, draught=2e3 * height)


@pytest.mark.parametrize(
    "operator",
    [
        bpy.ops.object.fairing_close,
        bpy.ops.object.fairing_hydrostatics,
        bpy.ops.object.fairing_section_curves,
        bpy.ops.export_scene.fairing_lines,
    ],
)
def test_a_mesh_without_faces_is_refused_in_words(operator, tmp_path):
    add("Wire", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)])
    file = {"filepath": str(tmp_path / "l.dxf")} if "lines" in operator.idname() else {}
    refused("^Error: Wire.* has no faces", operator, **file)


def test_sections_are_at_the_stations_of_the_table():
    half = imported("offsets_chine.csv")
    surface = fair(levels=3, symmetry_plane="Y")
    assert bpy.ops.object.fairing_section_curves(kind="STATIONS") == {"FINISHED"}
    made = {o.name: o for o in bpy.context.selected_objects}
    # the first station is a line in the middle plane: nothing is cut there
    assert set(made) >= {f"{surface.name} station {k}" for k in range(1, 9)}
    points = positions(half.data)
    for k in (2, 5):
        curve = made[f"{surface.name} station {k}"].data.splines[0]
        there = np.array([p.co[:3] for p in curve.points])
        assert there[:, 0] == pytest.approx(k, abs=1e-5)
        offsets = points[np.isclose(points[:, 0], k)]
        nearest = [np.linalg.norm(there - place, axis=1).min() for place in offsets]
        assert max(nearest) < 0.02


@pytest.mark.parametrize(
    "options, count",
    [
        ({"kind": "STATIONS", "places": "1, 2.5"}, 2),
        ({"kind": "WATERLINES", "spacing": 0.5, "start": 0.1}, 4),
        ({"kind": "BUTTOCKS", "spacing": 0.4, "start": 0.2}, 4),
        ({"kind": "DIAGONALS", "places": "0.5", "angle": 0.6}, 1),
        ({"kind": "WATERLINES", "places": "0.5 -0.5"}, 2),
        ({"kind": "WATERLINES", "places": "0,5; 9,5"}, 1),
        ({"kind": "WATERLINES"}, 9),
        ({"kind": "STATIONS"}, 5),
    ],
)
def test_sections_are_where_they_are_asked_for(options, count):
    add("Box", *CUBE)
    bpy.context.active_object.scale = (3.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    assert bpy.ops.object.fairing_section_curves(**options) == {"FINISHED"}
    made = bpy.context.selected_objects
    assert len(made) == count
    assert all(o.data.splines[0].use_cyclic_u for o in made)


def test_a_plane_object_cuts_across_its_z():
    target = add("Box", *CUBE)
    empty = bpy.data.objects.new("Cut", None)
    bpy.context.collection.objects.link(empty)
    empty.rotation_euler = (0.0, np.pi / 2, 0.0)
    empty.location = (0.25, 0.0, 0.0)
    bpy.context.view_layer.update()
    empty.select_set(True)
    target.select_set(True)
    assert bpy.ops.object.fairing_section_curves(kind="OBJECT") == {"FINISHED"}
    (spline,) = bpy.context.active_object.data.splines
    assert np.array([p.co[0] for p in spline.points]) == pytest.approx(0.25)


def test_the_lines_plan_has_a_body_plan_with_both_halves(tmp_path):
    imported("offsets_yacht.tsv")
    bpy.ops.object.fairing_close()
    fair(levels=2)
    path = tmp_path / "lines.dxf"
    options = {"filepath": str(path), "unit": "MM", "scale": 10.0}
    assert bpy.ops.export_scene.fairing_lines(**options) == {"FINISHED"}
    found = groups(path)
    assert found[-1] == (0, "EOF") and (1, "AC1009") in found
    layers = [value for code, value in found if code == 8]
    assert {"STATIONS", "BUTTOCKS", "WATERLINES", "TEXT", "GRID", "FRAME"} == set(layers)
    texts = [value for (code, value) in found if code == 1][1:]
    assert "station 5" in texts and texts.count("5") == 2, "below profile and half-breadths"
    assert "offsets_yacht Closed Fair   1 : 10   mm" in texts

    def places(layer):
        at = [k for k, pair in enumerate(found) if pair == (0, "VERTEX")]
        own = [k for k in at if found[k + 1][1] == layer]
        return np.array([[float(found[k + 2][1]), float(found[k + 3][1])] for k in own])

    frame = places("FRAME")
    for layer in ("GRID", "STATIONS", "WATERLINES", "BUTTOCKS"):
        there = places(layer)
        assert (there > frame.min(axis=0)).all() and (there < frame.max(axis=0)).all(), layer
    x = places("STATIONS")[:, 0]
    centre = 0.5 * (x.min() + x.max())
    # of 1.7 m to each side, ten times smaller, in millimetres
    assert x.max() - centre == pytest.approx(centre - x.min(), rel=0.2) and 200 < np.ptp(x) < 350
