# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings arrive at the core under its own names; creases and corners from plain arrays."""

import warnings
from dataclasses import replace

import bpy
import discrete_fairing as df
import numpy as np
import pytest
from polygons import polygons
from scenes import CUBE, add, set_edge_attribute

from addon import core
from addon.choices import ENERGIES, TOLERANCE_UNITS
from addon.core import (
    are_equal,
    corner_vertices,
    crease_edges,
    fair_arguments,
    mean_edge_length,
    soft_creases,
)
from addon.job import Job
from addon.mesh.read import ControlArrays, read_mesh
from addon.preferences import Defaults
from addon.settings import Settings


def settings(**changes):
    """The defaults as the panel has them, with some changed."""
    scene = bpy.context.scene.discrete_fairing
    return replace(Settings.of(scene), **changes)


def arguments(mesh=None, **changes):
    return fair_arguments(read_mesh(mesh or add("Box", *CUBE).data), settings(**changes), Defaults)


def test_values():
    given = arguments(
        levels=5, interpolation="APPROXIMATE", tolerance=0.25, tolerance_unit="SCENE", boundary="FREE", metric_exponent=1.0,
        use_crease_angle=True, crease_angle=1.0, use_corner_angle=True, corner_angle=2.0, repair="REFUSE", memory_limit=3,
    )  # fmt: skip
    assert (
        given["levels"] == 5
        and given["interpolation"] == "approximate"
        and given["tolerance"] == 0.25
    )
    assert given["boundary"] == "free" and given["metric_exponent"] == 1.0
    assert given["crease_angle"] == 1.0 and given["corner_angle"] == 2.0
    assert given["repair"] == "refuse" and given["memory_limit"] == 3 * 2**20


@pytest.mark.parametrize("energy", [key for key, *_ in ENERGIES])
def test_energies_are_those_of_the_core(energy):
    given = arguments(energy=energy)["energy"]
    assert given in core.module()._native.Energy.__members__ and given.upper() == energy


@pytest.mark.parametrize("unit", [key for key, *_ in TOLERANCE_UNITS])
def test_tolerance_belongs_to_approximation(unit):
    given = arguments(interpolation="EXACT", tolerance=0.25, tolerance_unit=unit)
    assert given["tolerance"] == 0.0


def test_a_tolerance_is_a_share_of_the_mean_edge():
    arrays = triangle()
    assert mean_edge_length(arrays) == pytest.approx((2 + 2**0.5) / 3), "the loose edge is left out"
    near = settings(interpolation="APPROXIMATE", tolerance=0.25, tolerance_unit="RELATIVE")
    assert fair_arguments(arrays, near, Defaults, edge_length=2.0)["tolerance"] == 0.5
    length = settings(interpolation="APPROXIMATE", tolerance=0.25, tolerance_unit="SCENE")
    assert fair_arguments(arrays, length, Defaults, edge_length=2.0)["tolerance"] == 0.25


def test_a_mesh_without_faces_has_no_edges_to_measure():
    nothing = np.empty(0, np.int32)
    arrays = replace(triangle(), corners=nothing, corner_edges=nothing, offsets=np.zeros(1, int))
    assert mean_edge_length(arrays) == 0.0


def test_shares_of_the_tolerance():
    near = settings(interpolation="APPROXIMATE", tolerance=0.5, tolerance_unit="SCENE")
    tolerance_factors = np.array([0.0, 0.25, 1.0, 0.0])
    given = fair_arguments(triangle(), near, Defaults, tolerance_factors=tolerance_factors)
    assert given["tolerance"].tolist() == [0.0, 0.125, 0.5, 0.0]


def test_nothing_is_measured_unasked():
    assert arguments()["measure"] is False


@pytest.mark.parametrize("energy", [key for key, *_ in ENERGIES])
@pytest.mark.parametrize("interpolation", ["EXACT", "APPROXIMATE"])
def test_the_core_takes_every_combination(energy, interpolation):
    given = arguments(
        energy=energy, interpolation=interpolation, pad_size=0.75, tension=0.25, levels=1
    )
    assert given["pad_size"] == 0.75
    assert given["tension"] == (0 if energy == "MINIMUM_VARIATION" else 0.25)
    assert len(core.module().fair(**given).vertices) == 26


@pytest.mark.parametrize(
    "name, data_type, value, changes",
    [
        ("crease_edge", "FLOAT", 1.0, {}),
        ("crease_edge", "FLOAT", 0.3, {"crease_threshold": 0.3}),
        ("sharp_edge", "BOOLEAN", True, {"use_sharp_edges": True}),
    ],
)
def test_creases_from_the_mesh(name, data_type, value, changes):
    mesh = add("Box", *CUBE).data
    set_edge_attribute(mesh, name, data_type, [(0, 1), (3, 7)], value)
    assert {
        tuple(sorted(pair)) for pair in arguments(mesh, **changes)["crease_edges"].tolist()
    } == {
        (0, 1),
        (3, 7),
    }


@pytest.mark.parametrize(
    "name, data_type, value, changes",
    [
        ("crease_edge", "FLOAT", 1.0, {"use_crease_attribute": False}),
        ("crease_edge", "FLOAT", 0.25, {}),
        ("sharp_edge", "BOOLEAN", True, {}),
    ],
)
def test_creases_that_were_not_asked_for(name, data_type, value, changes):
    mesh = add("Box", *CUBE).data
    set_edge_attribute(mesh, name, data_type, [(0, 1)], value)
    assert len(arguments(mesh, **changes)["crease_edges"]) == 0


def test_arrays_are_flat_and_whole():
    given = arguments()
    corners, offsets = given["faces"]
    assert corners.dtype == offsets.dtype == np.int32 and given["vertices"].dtype == np.float64
    assert given["vertices"].flags["C_CONTIGUOUS"]


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


@pytest.mark.parametrize(
    "threshold, expected",
    [(0.0, [(0, 1), (1, 2)]), (0.5, [(0, 1), (1, 2)]), (0.6, [(0, 1)]), (None, [])],
)
def test_crease_threshold(threshold, expected):
    weights = np.array([1.0, 0.5, 0.0, 1.0], np.float32)
    assert [tuple(e) for e in crease_edges(triangle(edge_crease=weights), threshold)] == expected


def test_creases_below_the_threshold_are_soft():
    weights = np.array([1.0, 0.5, 0.25, 0.5], np.float32)  # the last edge has no face
    edges, values = soft_creases(triangle(edge_crease=weights), 1.0)
    assert edges.tolist() == [[1, 2], [0, 2]] and values.tolist() == [0.5, 0.25]
    edges, values = soft_creases(triangle(edge_crease=weights), 0.5)
    assert edges.tolist() == [[0, 2]] and values.tolist() == [0.25]


def test_soft_creases_reach_the_core():
    mesh = add("Box", *CUBE).data
    set_edge_attribute(mesh, "crease_edge", "FLOAT", [(0, 1)], 0.5)
    edges, values = arguments(mesh)["soft_creases"]
    assert sorted(edges[0].tolist()) == [0, 1] and values.tolist() == [0.5]
    assert "soft_creases" not in arguments(mesh, use_crease_attribute=False)
    assert "soft_creases" not in arguments(mesh, interpolation="LIMIT")


def test_flat_faces_reach_the_core():
    mesh = add("Box", *CUBE).data
    marks = mesh.attributes.new("fair_flat", "BOOLEAN", "FACE")
    marks.data[2].value = marks.data[5].value = True
    assert arguments(mesh, energy="THIN_PLATE")["flat_faces"].tolist() == [2, 5]
    assert "flat_faces" not in arguments(mesh, energy="TOTAL_CURVATURE")


def test_threshold_compares_in_the_precision_of_the_attribute():
    weights = np.full(4, 0.1, np.float32)
    assert len(crease_edges(triangle(edge_crease=weights), 0.1)) == 3


def test_sharp_edges_add_to_creases():
    arrays = triangle(
        edge_crease=np.array([1, 0, 0, 0], np.float32),
        sharp_edge=np.array([True, False, True, True]),
    )
    assert [tuple(e) for e in crease_edges(arrays, 0.5, use_sharp=True)] == [(0, 1), (0, 2)]
    assert [tuple(e) for e in crease_edges(arrays, 0.5, use_sharp=False)] == [(0, 1)]
    assert [tuple(e) for e in crease_edges(arrays, None, use_sharp=True)] == [(0, 1), (0, 2)]


def test_corners_from_vertex_creases():
    weights = np.array([1.0, 0.2, 0.0, 1.0], np.float32)
    assert corner_vertices(triangle(vertex_crease=weights), 0.5).tolist() == [0]
    assert corner_vertices(triangle(vertex_crease=weights), None).tolist() == []


@pytest.mark.parametrize(
    "value", [None, 1, 0.5, "x", np.arange(3), (np.arange(3), np.arange(2)), {"a": 1}]
)
def test_equal_arguments(value):
    assert are_equal({"k": value}, {"k": value})


@pytest.mark.parametrize(
    "a, b",
    [
        (None, np.arange(3)),
        (np.arange(3), np.arange(4)),
        (np.arange(3), np.zeros(3, int)),
        ((np.arange(3), 1), (np.arange(3), 2)),
        ((1,), (1, 1)),
        ({"a": 1}, {"b": 1}),
        (1, True),
        (0.5, 0.25),
    ],
)
def test_different_arguments(a, b):
    assert not are_equal({"k": a}, {"k": b})


def grid(columns, rows):
    positions = [(x, y, 0) for y in range(rows + 1) for x in range(columns + 1)]
    wide = columns + 1
    faces = [
        [y * wide + x, y * wide + x + 1, (y + 1) * wide + x + 1, (y + 1) * wide + x]
        for y in range(rows)
        for x in range(columns)
    ]
    return positions, faces


def test_a_sheet_of_quads_keeps_its_corners():
    assert core.border_corners(polygons(*grid(3, 2))).tolist() == [0, 3, 8, 11]


@pytest.mark.parametrize("diagonal", ["one way", "the other way", "by turns"])
@pytest.mark.parametrize("columns", [1, 2, 3])
def test_a_sheet_of_triangles_keeps_the_same_corners(diagonal, columns):
    positions, quads = grid(columns, 2)
    triangles = []
    for k, (a, b, c, d) in enumerate(quads):
        turned = diagonal == "the other way" or (diagonal == "by turns" and k % 2)
        triangles += [[a, b, d], [b, c, d]] if turned else [[a, b, c], [a, c, d]]
    assert np.array_equal(
        core.border_corners(polygons(positions, triangles)),
        core.border_corners(polygons(positions, quads)),
    )


def test_corners_inside_a_sheet_are_none():
    spike = [(0, 0, 9), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]
    sides = [[0, i + 1, (i + 1) % 4 + 1] for i in range(4)]
    assert not len(core.border_corners(polygons(spike, sides)))


def test_a_hexagon_of_triangles_has_no_corners():
    angles = np.linspace(0, 2 * np.pi, 6, endpoint=False)
    points = [(0, 0, 0)] + [(np.cos(a), np.sin(a), 0) for a in angles]
    fan = [[0, i + 1, (i + 1) % 6 + 1] for i in range(6)]
    assert not len(core.border_corners(polygons(points, fan)))


def test_small_turns_are_no_corners():
    angles = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    disc = [(np.cos(a), np.sin(a), 0) for a in angles]
    assert not len(core.border_corners(polygons(disc, [list(range(8))])))


def test_the_open_end_of_a_tube_has_no_corners():
    positions = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    sides = [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    assert not len(core.border_corners(polygons(positions, sides)))


def test_an_edge_with_a_boundary_of_its_own_rounds_its_corners():
    plain = polygons(*grid(3, 2))
    marks = np.zeros(len(plain.edges), np.int32)
    marks[plain.edges.tolist().index([0, 1])] = 1
    assert core.border_corners(polygons(*grid(3, 2), boundary_edge=marks)).tolist() == [3, 8, 11]


def test_borders_do_not_end_in_the_symmetry_plane():
    assert core.border_corners(polygons(*grid(3, 2)), 0).tolist() == [3, 11]


def test_corners_are_the_default_and_a_choice_of_their_own():
    positions, faces = grid(3, 2)
    for boundary, wanted in (("CORNERS", [0, 3, 8, 11]), ("CURVE", []), ("LINEAR", [])):
        given = core.fair_arguments(
            polygons(positions, faces), settings(boundary=boundary), Defaults
        )
        assert given["corner_vertices"].tolist() == wanted
        assert given["boundary"] == ("curve" if boundary == "CORNERS" else boundary.lower())


def test_news_of_memory_stay_off_the_console(monkeypatch, recwarn):
    """The core tells callers in Python; of our own runs users read it in the report."""

    def takes_more(*args, **options):
        warnings.warn("more than predicted", df.MemoryWarning, stacklevel=2)
        return made(*args, **options)

    made = df.fair
    monkeypatch.setattr(df, "fair", takes_more)
    core._load.cache_clear()  # the filter is set with the first use
    job = Job(bpy.context, add("Box", *CUBE), Settings.of(bpy.context.scene.discrete_fairing))
    job.compute()
    assert job.result is not None and not recwarn.list
    core.module().fair(*CUBE, 1)
    assert [w.category for w in recwarn.list] == [df.MemoryWarning], "scripts of users hear of it"
