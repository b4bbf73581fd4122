# SPDX-License-Identifier: GPL-3.0-or-later
"""The check report: all kinds of defect at once, nothing raised, and the same verdict as a run's."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import one_sided_meshes
import pytest
from refusing import refusal
from surfaces import as_lists, half_edges
from test_mend_random import damaged

POINTS, FACES = meshes.icosahedron()


def found(vertices, faces, **options):
    """(code, elements) of every defect."""
    return [(d.code, d.elements) for d in df.check(vertices, faces, **options)]


@pytest.mark.parametrize("name", meshes.ALL)
def test_nothing_is_wrong_with_clean_meshes(name):
    vertices, faces = meshes.ALL[name]()
    assert df.check(vertices, faces) == []


def test_all_kinds_at_once():
    vertices = np.concatenate([POINTS, [[9.0, 9, 9], [7, 7, 7], [8, 8, 8]]])
    faces = as_lists(FACES)
    a, b, _ = faces[0]
    turned = faces[5][::-1]
    faces[5] = turned
    faces += [[a, b, 13]]  # a third face at an edge
    faces += [faces[9]]  # one twice
    report = {d.code: d for d in df.check(vertices, faces)}
    assert list(report) == [
        "DUPLICATE_FACE",
        "NONMANIFOLD_EDGE",
        "INCONSISTENT_ORIENTATION",
        "ISOLATED_VERTICES",
    ]
    assert report["DUPLICATE_FACE"].elements == [9, 21] and report["DUPLICATE_FACE"].kind == "face"
    edges = {tuple(sorted(e)) for e in half_edges([faces[9]])} | {(min(a, b), max(a, b))}
    assert {tuple(e) for e in report["NONMANIFOLD_EDGE"].elements} == edges
    assert report["NONMANIFOLD_EDGE"].kind == "edge"
    assert report["INCONSISTENT_ORIENTATION"].repairable
    assert 5 in report["INCONSISTENT_ORIENTATION"].elements
    assert report["ISOLATED_VERTICES"].elements == [12, 14]
    assert report["ISOLATED_VERTICES"].kind == "vertex"
    warnings = ("NONMANIFOLD_EDGE", "ISOLATED_VERTICES")
    assert all((d.severity == "warning") == (c in warnings) for c, d in report.items())


def test_what_ends_the_search():
    faces = FACES.copy()
    faces[3, 1] = 99
    faces[4, 1] = faces[4, 0]
    vertices = POINTS.copy()
    vertices[2, 1] = np.nan
    assert found(vertices, faces) == [
        ("NON_FINITE", [2]),
        ("INDEX_OUT_OF_RANGE", [3]),
        ("REPEATED_VERTEX", [4]),
    ]
    assert found([], []) == [("EMPTY_MESH", [])]
    assert df.check([], [])[0].kind == "mesh"
    assert found(POINTS, []) == [("NO_FACES", [])]
    assert found(POINTS, [[0, 1], [1, 2, 3]]) == [("BAD_SHAPE", [0])]


def test_coincidence_and_area_together():
    vertices = np.array(
        [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 1, 0], [0, 1, 0], [2, 2, 0]]
    )
    vertices = np.concatenate([vertices, [[2, 0, 0]]])
    faces = [[0, 1, 2, 3], [7, 6, 4], [0, 3, 5]]
    # 3 and 5 are one point in one face; 2 and 4 are a seam
    report = df.check(vertices, faces)
    assert [(d.code, d.elements, d.severity) for d in report] == [
        ("COINCIDENT_VERTICES", [3, 5], "error"),
        ("COINCIDENT_VERTICES", [2, 4], "warning"),
        ("DEGENERATE_FACE", [2], "error"),
    ]


def test_orientation_and_one_sidedness_of_different_parts():
    strip, quads = one_sided_meshes.strip(7, 1)
    flipped = FACES.copy()
    flipped[3] = flipped[3, ::-1]
    vertices = np.concatenate([POINTS, strip + [9, 0, 0]])
    faces = as_lists(flipped) + as_lists(quads + len(POINTS))
    one_sided = list(range(20, 20 + len(quads)))
    assert found(vertices, faces) == [
        ("NON_ORIENTABLE", one_sided),
        ("INCONSISTENT_ORIENTATION", [3]),
    ]


@pytest.mark.parametrize("seed", range(120))
def test_the_first_error_is_the_one_that_stops_a_run(seed):
    points, faces = damaged(seed)
    report = df.check(points, faces)
    errors = [d for d in report if d.severity == "error"]
    assert len({(d.code, d.severity) for d in report}) == len(report)
    if not errors:
        result = df.fair(points, faces, 0)
        assert [w["code"] for w in result.report["warnings"]] == [d.code for d in report]
        assert [w["kind"] for w in result.report["warnings"]] == [d.kind for d in report]
        return
    error = refusal(df.fair, points, faces, 0)
    flat = np.array(errors[0].elements).reshape(-1).tolist()
    assert (error.code, error.elements, error.kind) == (errors[0].code, flat, errors[0].kind)
    assert str(error) == errors[0].message
