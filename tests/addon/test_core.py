# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings reach the core under its own names; creases and corners come from plain arrays."""

from dataclasses import replace

import numpy as np
import pytest
from lattices import lattice_faces
from polygons import polygons
from scenes import CUBE, add, set_edge_attribute, settings

from addon.choices import TOLERANCE_UNITS
from addon.core import border_corners, fair_arguments
from addon.mesh.read import ControlArrays, read_mesh
from addon.preferences import Defaults


def arguments(mesh=None, **changes):
    return fair_arguments(read_mesh(mesh or add("Box", *CUBE).data), settings(**changes), Defaults)


def test_values():
    given = arguments(
        levels=5, interpolation="APPROXIMATE", tolerance=0.25, tolerance_unit="SCENE", boundary="FREE", metric_exponent=1.0,
        use_crease_angle=True, crease_angle=1.0, use_corner_angle=True, corner_angle=2.0, repair="REFUSE",
    )  # fmt: skip
    expected = {
        "levels": 5, "interpolation": "approximate", "tolerance": 0.25, "boundary": "free", "metric_exponent": 1.0,
        "crease_angle": 1.0, "corner_angle": 2.0, "repair": "refuse", "measure": False,
    }  # fmt: skip
    assert {name: given[name] for name in expected} == expected
    corners, offsets = given["faces"]
    assert corners.dtype == offsets.dtype == np.int32 and given["vertices"].dtype == np.float64
    for unit, *_ in TOLERANCE_UNITS:  # which belongs to approximation
        exact = arguments(interpolation="EXACT", tolerance=0.25, tolerance_unit=unit)
        assert exact["tolerance"] == 0.0


def test_a_tolerance_is_a_share_of_the_mean_edge():
    arrays = triangle()
    assert arrays.mean_edge_length == pytest.approx((2 + 2**0.5) / 3), "the loose edge is left out"
    near = settings(interpolation="APPROXIMATE", tolerance=0.25, tolerance_unit="RELATIVE")
    assert fair_arguments(arrays, near, Defaults, edge_length=2.0)["tolerance"] == 0.5
    length = settings(interpolation="APPROXIMATE", tolerance=0.25, tolerance_unit="SCENE")
    assert fair_arguments(arrays, length, Defaults, edge_length=2.0)["tolerance"] == 0.25
    factors = np.array([0.0, 0.25, 1.0, 0.0])
    given = fair_arguments(arrays, length, Defaults, tolerance_factors=factors)
    assert given["tolerance"].tolist() == [0.0, 0.0625, 0.25, 0.0]
    nothing = np.empty(0, np.int32)
    bare = replace(arrays, corners=nothing, corner_edges=nothing, offsets=np.zeros(1, int))
    assert bare.mean_edge_length == 0.0


PAIRS = {(0, 1), (3, 7)}


@pytest.mark.parametrize(
    "name, data_type, value, changes, expected",
    [
        ("crease_edge", "FLOAT", 1.0, {}, PAIRS),
        ("crease_edge", "FLOAT", 0.3, {"crease_threshold": 0.3}, PAIRS),
        ("sharp_edge", "BOOLEAN", True, {"use_sharp_edges": True}, PAIRS),
        ("crease_edge", "FLOAT", 1.0, {"use_crease_attribute": False}, set()),
        ("crease_edge", "FLOAT", 0.25, {}, set()),
        ("sharp_edge", "BOOLEAN", True, {}, set()),
        ("crease_edge", "INT", 1, {}, set()),  # a stranger by the same name
    ],
)
def test_creases_from_the_mesh(name, data_type, value, changes, expected):
    mesh = add("Box", *CUBE).data
    set_edge_attribute(mesh, name, data_type, PAIRS, value)
    given = arguments(mesh, **changes)
    assert {tuple(sorted(pair)) for pair in given["crease_edges"].tolist()} == expected
    if value == 0.25:
        edges, values = given["soft_creases"]
        assert {tuple(sorted(pair)) for pair in edges.tolist()} == PAIRS
        assert values.tolist() == [0.25, 0.25]
        assert "soft_creases" not in arguments(mesh, use_crease_attribute=False)
        assert "soft_creases" not in arguments(mesh, interpolation="LIMIT")


def triangle(**attributes):
    """One triangle 0 1 2 and a loose edge 2 3."""
    nothing = dict.fromkeys(("edge_crease", "vertex_crease", "sharp_edge"))
    return ControlArrays(
        positions=np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 2, 0)], float),
        edges=np.array([(0, 1), (1, 2), (0, 2), (2, 3)], np.int32),
        corners=np.array([0, 1, 2], np.int32),
        corner_edges=np.array([0, 1, 2], np.int32),
        offsets=np.array([0, 3], np.int32),
        **{**nothing, **attributes},
    )


def test_creases_below_the_threshold_are_soft():
    weights = np.array([1.0, 0.5, 0.25, 0.5], np.float32)  # the last edge has no face
    edges, values = triangle(edge_crease=weights).soft_creases(1.0)
    assert edges.tolist() == [[1, 2], [0, 2]] and values.tolist() == [0.5, 0.25]
    edges, values = triangle(edge_crease=weights).soft_creases(0.5)
    assert edges.tolist() == [[0, 2]] and values.tolist() == [0.25]


def test_flat_faces_reach_the_core():
    mesh = add("Box", *CUBE).data
    marks = mesh.attributes.new("fair_flat", "BOOLEAN", "FACE")
    marks.data[2].value = marks.data[5].value = True
    found = arguments(mesh, energy="THIN_PLATE", metric_exponent=0.5)
    assert found["flat_faces"].tolist() == [2, 5] and found["metric_exponent"] == 0.95
    assert arguments(mesh, energy="THIN_PLATE", metric_exponent=1.0)["metric_exponent"] == 1.0
    found = arguments(mesh, energy="TOTAL_CURVATURE", metric_exponent=0.5)
    assert "flat_faces" not in found and found["metric_exponent"] == 0.5


def sheet(columns=3, rows=2):
    """Points and quads, row by row."""
    points = [(x, y, 0) for x in range(columns + 1) for y in range(rows + 1)]
    return points, lattice_faces(columns + 1, rows + 1).tolist()


@pytest.mark.parametrize("diagonal", ["none", "one way", "the other way", "by turns"])
@pytest.mark.parametrize("columns", [1, 2, 3])
def test_a_sheet_keeps_its_corners_whatever_its_faces(diagonal, columns):
    positions, faces = sheet(columns)
    if diagonal != "none":
        triangles = []
        for k, (a, b, c, d) in enumerate(faces):
            turned = diagonal == "the other way" or (diagonal == "by turns" and k % 2)
            triangles += [[a, b, d], [b, c, d]] if turned else [[a, b, c], [a, c, d]]
        faces = triangles
    wanted = [0, 2, 3 * columns, 3 * columns + 2]
    assert border_corners(polygons(positions, faces)).tolist() == wanted


def ring(count):
    return [(np.cos(a), np.sin(a), 0) for a in np.linspace(0, 2 * np.pi, count, endpoint=False)]


CORNERLESS = {
    "a spike inside": ([(0, 0, 9), *ring(4)], [[0, i + 1, (i + 1) % 4 + 1] for i in range(4)]),
    "a hexagon": ([(0, 0, 0), *ring(6)], [[0, i + 1, (i + 1) % 6 + 1] for i in range(6)]),
    "small turns": (ring(8), [list(range(8))]),
    "the ends of a tube": (
        [(x, y, z) for z in (0, 1) for x, y, _ in ring(4)],
        [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)],
    ),
}


@pytest.mark.parametrize("name", CORNERLESS)
def test_what_has_no_corners(name):
    assert not len(border_corners(polygons(*CORNERLESS[name])))


def test_an_edge_with_a_boundary_of_its_own_rounds_its_corners():
    plain = polygons(*sheet())
    assert border_corners(plain).tolist() == [0, 2, 9, 11]
    marks = np.zeros(len(plain.edges), np.int32)
    marks[plain.edges.tolist().index([0, 1])] = 1
    assert border_corners(polygons(*sheet(), boundary_edge=marks)).tolist() == [2, 9, 11]


def test_no_border_ends_in_the_symmetry_plane():
    given = fair_arguments(polygons(*sheet()), settings(symmetry_plane="Y"), Defaults)
    assert given["corner_vertices"].tolist() == [2, 11]


def test_corners_are_the_default_and_a_choice_of_their_own():
    for boundary, wanted in (("CORNERS", [0, 2, 9, 11]), ("CURVE", []), ("LINEAR", [])):
        given = fair_arguments(polygons(*sheet()), settings(boundary=boundary), Defaults)
        assert given["corner_vertices"].tolist() == wanted
        assert given["boundary"] == ("curve" if boundary == "CORNERS" else boundary.lower())
