# SPDX-License-Identifier: GPL-3.0-or-later
"""No energy leaves folds that the control mesh does not have."""

from itertools import product

import bevelled_boxes
import control_meshes as meshes
import discrete_fairing as df
import folding_meshes as folding
import numpy as np
import pytest
import tight
from scans import sheet
from surface_measures import turns
from surfaces import comes_near


def folds(points, triangles):
    """Edges across which normals turn by over 90 degrees: their ends (k, 2), and the two triangles (k, 2) at each."""
    edges, pairs, angle = turns(points, triangles)
    folded = angle > np.pi / 2
    return edges[folded], pairs[folded]


def polygons_of(result):
    """Of every triangle."""
    return np.concatenate([result.triangle_polygon, np.repeat(result.quad_polygon, 2)])


def own_folds(result, mesh) -> int:
    """The number of folds outside the polygons with a vertex at a fold of the control mesh."""
    control = tight.fair(*mesh, 0)
    ends, _ = folds(control.vertices, control.triangles)
    touched = np.isin(control.triangles, ends).any(1)
    excused = np.unique(polygons_of(control)[touched])
    _, beside = folds(result.vertices, result.triangles)
    return int((~np.isin(polygons_of(result)[beside], excused).any(1)).sum())


def fair(mesh, levels=2, **options):
    return tight.fair(*mesh, levels, energy="total_curvature", **options)


@pytest.mark.parametrize("seed, levels", [(3, 2), (11, 2), (4, 3)])
def test_a_rough_ball_is_unfolded(seed, levels):
    mesh = meshes.rough_ball(seed)
    result = fair(mesh, levels)
    last = result.report["curvature"][-1]
    assert last["folds_before"] > 0 and last["folds"] == 0
    assert own_folds(result, mesh) == 0
    assert comes_near(last) and last["energy"] <= last["plate_energy"]
    assert result.vertices[: len(mesh[0])].tobytes() == mesh[0].tobytes()
    assert result.report["peak_bytes"] <= result.report["predicted_bytes"]


@pytest.mark.parametrize("triangles", [False, True])
def test_steps_to_less_variation_that_fold_give_their_start_back(triangles):
    """Sharp pleats: these steps do not converge, and left over 700 folds."""
    line = np.linspace(-1, 1, 21)
    rise = 0.1 * np.tan(np.radians(78 / 2)) * (np.arange(21) % 2)
    mesh = sheet(line, line, lambda x, y: np.broadcast_to(rise[:, None], x.shape))
    mesh = meshes.cut_quads(mesh) if triangles else mesh
    result = df.fair(*mesh, 2, energy="minimum_variation")
    assert own_folds(result, mesh) == 0
    assert "NOT_CONVERGED_START" in [w["code"] for w in result.report["warnings"]]


@pytest.mark.parametrize("name", ["icosahedron", "cube", "dodecahedron", "house", "fan8", "roof"])
def test_no_folds_no_cure(name):
    last = fair(meshes.ALL[name](), 3).report["curvature"][-1]
    assert (last["folds_before"], last["folds"]) == (0, 0)


OUTLINES = {
    "corner": folding.corner(),
    "arrow": folding.arrow(),
    "star": folding.star(),
    "comb": folding.comb(),
    "star of 8": folding.star(8),
    "star of 24": folding.star(24),
    "scattered": folding.scattered(),
}


@pytest.mark.parametrize("boundary", ["linear", "curve"])
@pytest.mark.parametrize("name, levels", [*product(OUTLINES, (1, 2, 3)), ("corner", 6)])
def test_a_flat_mesh_stays_one_layer(name, levels, boundary):
    vertices, faces = OUTLINES[name]
    result = df.fair(vertices, faces, levels, boundary=boundary)
    corner = result.vertices[result.triangles]
    area = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 2]
    assert not result.vertices[:, 2].any()
    assert area.min() > -1e-12 * np.abs(area).sum()
    assert result.vertices[: len(vertices)].tobytes() == vertices.tobytes()


THIN_BOX = bevelled_boxes.bevelled_box((1, 1, 0.02), 0.0001)
THIN_PLATES = {
    "rounded box of 16": (folding.rounded_box(16), 3, {}),
    "rounded box of 32": (folding.rounded_box(32), 2, {}),
    "rounded box, uniform": (folding.rounded_box(32), 1, {"metric_exponent": 0.0}),
    "rounded box, point forces": (folding.rounded_box(32), 1, {"pad_size": 0.0}),
    "rounded box, tension": (folding.rounded_box(32), 1, {"tension": 0.5}),
    "plate with a bevel of a 200th": (THIN_BOX, 2, {}),
    "plate with a bevel of a 200th, finer": (THIN_BOX, 3, {}),
    "plate with a bevel of a 200th, true lengths": (THIN_BOX, 3, {"metric_exponent": 1.0}),
    "box with a bevel of a 500th": (
        bevelled_boxes.bevelled_box((1, 0.5, 0.2), 0.0004),
        2,
        {"metric_exponent": 0.25},
    ),
    "hanging vertex": (folding.octahedron_with_a_hanging_vertex(), 3, {}),
}


@pytest.mark.parametrize("name", THIN_PLATES)
def test_the_thin_plate_has_no_folds_of_its_own(name):
    mesh, levels, options = THIN_PLATES[name]
    result = df.fair(*mesh, levels, **options)
    assert own_folds(result, mesh) == 0
    assert result.vertices[: len(mesh[0])].tobytes() == mesh[0].tobytes()


def test_a_mix_of_shapes_is_unfolded_as_they_are():
    vertices, faces = folding.rounded_box()
    bent = vertices + np.sin(vertices[:, [1, 2, 0]])
    mix = 0.25 * vertices + 0.75 * bent
    result = tight.fair(vertices, faces, 2, shapes=[bent, mix])
    assert own_folds(result, (vertices, faces)) == 0
    wanted = 0.25 * result.vertices + 0.75 * result.shapes[0]
    assert np.abs(result.shapes[1] - wanted).max() < 1e-6 * np.ptp(vertices)


@pytest.mark.parametrize("faces", [1, 2, 4])
def test_a_narrow_strip_stays_narrow(faces):
    width = 0.001
    mesh = folding.strip(width, faces)
    result = df.fair(*mesh, 3)
    assert np.ptp(result.vertices[:, 1]) <= 1.01 * width
    warning = next(w for w in result.report["warnings"] if w["code"] == "STRAIGHT_CURVE")
    sides = [(i, i + 1) for i in (*range(faces), *range(faces + 1, 2 * faces + 1))]
    assert set(sides) <= set(map(tuple, np.reshape(warning["elements"], (-1, 2)).tolist()))
