# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Offsets: the mesh in Blender, its names, and its strain."""

from dataclasses import asdict

import bpy
import hulls
import numpy as np
import pytest
from scenes import EXAMPLES, activate, computed, fair, positions, settings

from addon.mesh.offset_names import read_names, stations
from addon.strain.measure import StrainJob
from addon.yard.hull_mesh import hull_mesh
from addon.yard.offsets import Offset, Offsets, read


def imported(path, **options):
    assert bpy.ops.import_mesh.fairing_offsets(filepath=str(path), **options) == {"FINISHED"}
    return bpy.context.active_object


def test_the_mesh_has_names_creases_and_the_middle_plane():
    hull = imported(EXAMPLES / "offsets_chine.csv")
    assert bpy.context.scene.discrete_fairing.symmetry_plane == "Y"
    names = read_names(hull.data)
    assert names[6] == "station 1, Bottom"
    weights = hull.data.attributes["crease_edge"].data
    creased = {frozenset(e.vertices) for e in hull.data.edges if weights[e.index].value == 1.0}
    assert len(creased) == 20
    for line in ("Chine", "Sharp keel"):
        along = [names.index(f"station {k}, {line}") for k in range(9)]
        assert creased >= {frozenset(pair) for pair in zip(along, along[1:])}
    found = stations(names, positions(hull.data)[:, 0])
    assert found == [(f"station {k}", pytest.approx(k)) for k in range(9)]


@pytest.mark.parametrize(
    ("section", "sharp"),
    [
        ([(0, 0), (1, 0.4), (2, 0.8)], True),  # deadrise
        ([(0, 0), (1, 0), (2, 0)], False),  # flat
        ([(0, 0), (0.5, 0.13), (0.87, 0.5), (1, 1)], False),  # round
        ([(0, 0), (0.25, 0.13), (0.43, 0.5), (0.5, 1.0)], False),  # twice as high as broad
        ([(0, 0), (0.1, 0.4), (0.6, 1.0)], True),  # hollow
    ],
)
@pytest.mark.parametrize("side", [1, -1])
def test_the_middle_is_sharp_where_the_sections_are(section, sharp, side):
    rows = [(x, k, y, z) for x in (0, 1) for k, (y, z) in enumerate(section)]
    points = [Offset(f"{x}", f"L{k}", (x, side * y, z)) for x, k, y, z in rows]
    made = hull_mesh(Offsets(["0", "1"], [p.line for p in points[: len(section)]], points))
    assert made.creases == ([(0, len(section))] if sharp else [])


def test_a_sharp_keel_stays_sharp_where_waterlines_end_on_it():
    head = "station (m),Keel,WL 0.1,WL 0.2,WL 0.4,WL 0.6,WL 0.8"
    rows = [head]
    for x in range(9):
        keel = 0.01 * x**2
        breadths = (f"{2 * (z - keel):.3f}" if z > keel else "" for z in (0.1, 0.2, 0.4, 0.6, 0.8))
        rows.append(",".join([str(x), f"{keel:.3f}", *breadths]))
    made = hull_mesh(read("\n".join(rows)))
    keel = [made.names.index(f"station {x}, Keel") for x in range(9)]
    assert made.creases == sorted((min(pair), max(pair)) for pair in zip(keel, keel[1:]))


def test_a_dropped_file_is_imported_and_the_menu_asks():
    assert bpy.types.IO_FH_fairing_offsets.bl_import_operator == "import_mesh.fairing_offsets"
    known = bpy.ops.import_mesh.fairing_offsets.get_rna_type().properties
    assert known["filepath"].is_skip_save, "else the menu would read it again"


def test_stations_without_places_are_told(tmp_path, capfd):
    file = tmp_path / "numbered.csv"
    table = "station (cm),Keel,WL 50,WL 100\n0,0,90,140\n1,0,95,150\n2,5,60,120\n"
    file.write_text(table)
    imported(file)
    assert "give places in a column x" in capfd.readouterr().out
    file.write_text(f"spacing,200\n{table}")
    assert np.ptp(positions(imported(file).data)[:, 0]) == pytest.approx(4.0)
    assert "column x" not in capfd.readouterr().out


def test_a_table_with_an_error_leaves_nothing(tmp_path):
    file = tmp_path / "bad.csv"
    file.write_text("station (mm),Keel,WL 0\n0,1,2\n1,2,3x\n")
    with pytest.raises(RuntimeError, match=r"bad.csv: Row 3, column 3: '3x' is not a number"):
        imported(file)
    file.write_bytes(b"\xff\x00\x81")
    with pytest.raises(RuntimeError, match="UTF-8"):
        imported(file)
    with pytest.raises(RuntimeError, match="cannot be read"):
        imported(tmp_path / "none.csv")
    assert not bpy.data.meshes and not bpy.data.objects


@pytest.mark.parametrize("make", hulls.HULLS)
def test_wrong_offsets_are_found_by_name(make):
    table = make()
    found = computed(StrainJob(bpy.context, imported(EXAMPLES / table.file))).result
    panel = bpy.context.scene.discrete_fairing
    # no crease ends inside; a round keel of the others runs into a sharp stem
    assert panel.energy == ("MINIMUM_VARIATION" if "chine" in table.file else "THIN_PLATE")
    assert panel.use_corner_angle
    named = {f"station {station}, {line}" for station, line in table.wrong}
    listed = {found.name(i) for i in found.wrong.tolist()}
    assert named <= listed
    # three stations of a bulb are too few for its shape: that strains, too
    assert listed == named or "bulb" in table.file


def folds(surface):
    """The angles in degrees between the two halves, at each edge of the keel and of the bulb's underside."""
    middle = positions(surface.data)[:, 1] == 0.0
    low = positions(surface.data)[:, 2] < -1.2
    found = [
        2.0 * np.arcsin(abs(polygon.normal.y))
        for polygon in surface.data.polygons
        for v, w in polygon.edge_keys
        if middle[v] and middle[w] and low[v] and low[w]
    ]
    return np.degrees(found)


def test_a_bulb_is_round_at_the_symmetry_plane_and_its_keel_has_no_lumps():
    half = imported(EXAMPLES / "offsets_bulb.csv")
    panel = asdict(settings())
    coarse = fair(**panel | {"levels": 2})
    activate(half)
    fine = fair(**panel)
    assert np.median(folds(fine)) < 0.6 * np.median(folds(coarse)) < 20.0, "smooth: half a level"
    points = positions(fine.data)
    keel = points[(points[:, 1] == 0.0) & (points[:, 2] < -0.94) & (points[:, 0] < 10.8)]
    truth = [hulls.bulb_ends(min(1000.0 * x, 0.0))[0] if x <= 0 else -1500.0 for x in keel[:, 0]]
    off = np.abs(keel[:, 2] - np.array(truth) / 1000.0)
    assert len(keel) > 80 and off[keel[:, 0] > 1.2].max() < 0.012
    for edge in half.data.edges:
        if not positions(half.data)[list(edge.vertices), 1].any():
            half.data.attributes["crease_edge"].data[edge.index].value = 1.0
    activate(half)
    assert np.median(folds(fair(**panel))) > 3.0 * np.median(folds(fine)), "unless creased"
