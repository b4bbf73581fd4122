# SPDX-License-Identifier: GPL-3.0-or-later
"""Every defect ends in a FairingError with its code and elements; nothing is changed, the process lives on."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from refusing import refusal
from surfaces import as_lists

NAN, INF = float("nan"), float("inf")
POINTS, FACES = meshes.icosahedron()


def refused(vertices, faces, *args, **options):
    """The error; neither array may change."""
    before = [
        np.array(a, copy=True) if isinstance(a, np.ndarray) else repr(a) for a in (vertices, faces)
    ]
    error = refusal(df.fair, vertices, faces, *args, **options)
    for now, was in zip((vertices, faces), before):
        same = now.tobytes() == was.tobytes() if isinstance(now, np.ndarray) else repr(now) == was
        assert same
    assert isinstance(error, ValueError)
    assert error.code.isupper() and len(str(error)) > 15 and str(error)[-1] in ".)"
    return error


def assert_refused(code, elements, *args, **options):
    error = refused(*args, **options)
    assert (error.code, list(error.elements)) == (code, elements), str(error)


def with_row(array, row, value):
    changed = np.array(array)
    changed[row] = value
    return changed


EMPTY, NO_FACES, FLIPPED = np.empty((0, 3)), np.empty((0, 3), int), FACES.copy()
FLIPPED[[3, 11]] = FLIPPED[[3, 11], ::-1]
TURNED = FACES[7:8, [1, 2, 0]]
GRID = meshes.grid(2, 2)[0]
CUT = meshes.cut_quads(meshes.grid(2, 2))[1]
NEEDLE = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-14, 0]])
FIRST, SECOND = sorted(FACES[6, :2].tolist())


@pytest.mark.parametrize(
    "code, elements, vertices, faces",
    [
        ("EMPTY_MESH", [], EMPTY, NO_FACES),
        ("EMPTY_MESH", [], [], []),
        ("EMPTY_MESH", [], EMPTY, FACES),
        ("NO_FACES", [], POINTS, NO_FACES),
        ("NO_FACES", [], POINTS, []),
        ("REPEATED_VERTEX", [2], POINTS, with_row(FACES, 2, [1, 1, 5])),
        ("REPEATED_VERTEX", [0], POINTS, [[0, 1, 2, 1], *as_lists(FACES)]),
        ("DUPLICATE_FACE", [4, 20], POINTS, np.concatenate([FACES, FACES[4:5]])),
        ("DUPLICATE_FACE", [7, 20], POINTS, np.concatenate([FACES, TURNED])),
        ("DUPLICATE_FACE", [7, 20], POINTS, np.concatenate([FACES, TURNED[:, ::-1]])),
        ("INCONSISTENT_ORIENTATION", [3, 11], POINTS, FLIPPED),
        (
            "DEGENERATE_FACE",
            [8],
            np.concatenate([GRID, [[0.5, 0.0, 0.0]]]),
            np.concatenate([CUT, [[1, 0, 9]]]),
        ),
        ("DEGENERATE_FACE", [0], NEEDLE, [[0, 1, 2]]),
        ("COINCIDENT_VERTICES", [FIRST, SECOND], with_row(POINTS, SECOND, POINTS[FIRST]), FACES),
    ],
)
def test_defects(code, elements, vertices, faces):
    assert_refused(code, elements, vertices, faces)


@pytest.mark.parametrize("value", [NAN, INF, -INF, 1e200])
def test_non_finite_coordinate(value):
    vertices = with_row(with_row(POINTS, 4, [0, value, 0]), 9, [value, value, 1])
    assert_refused("NON_FINITE", [4, 9], vertices, FACES)


@pytest.mark.parametrize("index", [12, -1, 10**9, 2**31, 2**40, -(2**33), 2**62, 2**64 - 1])
def test_index_out_of_range(index):
    faces = FACES.astype(np.uint64 if index > 2**63 else np.int64)
    assert_refused("INDEX_OUT_OF_RANGE", [3], POINTS, with_row(faces, 3, [0, 1, index]))


def test_area_is_judged_by_shape_and_not_by_size():
    assert df.fair(1e-30 * POINTS, FACES, 1).report["converged"]
    assert df.fair(1e-7 * POINTS + 5.0, FACES, 1).report["converged"]
    for scale in (1e-6, 1e6):
        thin = scale * np.array([[0, 0, 0], [1, 0, 0], [0, 1e-9, 0]])
        assert not df.check(thin, [[0, 1, 2]])
        thin[2, 1] = 1e-13 * scale
        assert_refused("DEGENERATE_FACE", [0], thin, [[0, 1, 2]])


@pytest.mark.parametrize(
    "vertices, faces",
    [
        (POINTS[:, :2], FACES),
        (np.array(1.0), FACES),
        (POINTS, FACES[:, :2]),
        (POINTS, [[0, 1]]),
        (POINTS, [[0, 1, 2], [3]]),
        (POINTS, FACES.astype(float)),
        (POINTS, [[0.0, 1.0, 2.0]]),
        (POINTS, FACES.astype(bool)),
        (POINTS + 1j, FACES),
        (POINTS.astype(str), FACES),
        ([[0, 0, 0], [1, 0], [0, 1, 0]], FACES),
        (None, FACES),
        (POINTS, (np.arange(6), np.array([0, 4, 2, 6]))),
        (POINTS, "012"),
        (POINTS, [None, [0, 1, 2]]),
    ],
)
def test_wrong_shape_or_type(vertices, faces):
    assert refused(vertices, faces).code == "BAD_SHAPE"


LEVELS = [-1, -(2**40), 16, 10**6, 2**31, 2**70]
LEVELS += [2.5, 2.0, "3", None, [1], {}, np.array([2]), np.array([1, 2]), NAN]


@pytest.mark.parametrize("levels", LEVELS, ids=repr)
def test_levels_that_are_no_whole_number_in_range(levels):
    assert_refused("BAD_OPTION", [], POINTS, FACES, levels)


STRANGE = {
    "energy": ["cheap", None, 7],
    "chart": ["conformal"],
    "interpolation": ["EXACT"],
    "boundary": ["", ["curve"]],
    "method": [1],
    "metric_exponent": [-0.01, 1.5, NAN, "half"],
    "chart_blend": [2, INF],
    "epsilon": [-1, INF, None, 10**400],
    "relative_residual": [0, -1, 1],
    "max_iterations": [0, -1],
    "threads": [-1, 10**6, 1.5, np.array([1, 2])],
    "memory_limit": [-1],
    "crease_angle": [NAN, "sharp"],
    "corner_angle": [INF],
    "smoother_degree": [-2],
    "sweeps": [-1],
    "measure": [np.zeros(3)],
    "pad_size": [np.array([1.0, 0.0]), -0.1, 1.5],
    "tension": [-0.1, 1.1, NAN],
}
TOGETHER = [
    {"tolerance": -1e-9, "interpolation": "approximate"},
    {"tolerance": NAN, "interpolation": "approximate"},
    {"weights": np.ones(12), "interpolation": "exact"},
    {"tension": 0.5, "energy": "minimum_variation"},
    {"region": [0], "joint": "smooth"},
    {"method": "back_leg", "tolerance": 0.1, "interpolation": "approximate"},
]


@pytest.mark.parametrize(
    "option", [*({k: v} for k, values in STRANGE.items() for v in values), *TOGETHER], ids=str
)
def test_strange_options(option):
    assert_refused("BAD_OPTION", [], POINTS, FACES, 1, **option)


def test_creases_that_are_no_edges():
    neighbours = {frozenset(e) for f in as_lists(FACES) for e in zip(f, [*f[1:], f[0]])}
    far = next(v for v in range(1, 12) if frozenset((0, v)) not in neighbours)
    good = sorted(next(iter(neighbours)))
    assert_refused("BAD_FEATURE_EDGE", [0, far], POINTS, FACES, crease_edges=[good, [0, far]])
    assert_refused("BAD_FEATURE_EDGE", [3, 3], POINTS, FACES, crease_edges=[[3, 3]])
    quads = meshes.cube()
    assert_refused("BAD_FEATURE_EDGE", [0, 3], *quads, crease_edges=[[0, 3]])


def test_features_out_of_range():
    assert_refused("INDEX_OUT_OF_RANGE", [99], POINTS, FACES, crease_edges=[[0, 99]])
    assert_refused("INDEX_OUT_OF_RANGE", [-1, 12], POINTS, FACES, corner_vertices=[-1, 3, 12])


@pytest.mark.parametrize("edges", [[0, 1, 2], [[0, 1, 2]], [[0.0, 1.0]], [[0], [1, 2]]], ids=str)
def test_features_of_wrong_shape(edges):
    assert refused(POINTS, FACES, crease_edges=edges).code == "BAD_SHAPE"
    assert refused(POINTS, FACES, corner_vertices=[0.5]).code == "BAD_SHAPE"
    assert refused(POINTS, FACES, corner_vertices=["a"]).code == "BAD_SHAPE"


@pytest.mark.parametrize(
    "levels, limit, has",
    [(5, 10**6, str(20 * 4**5)), (15, None, str(20 * 4**15)), (14, 2**50, "32")],
    ids=["the limit", "this machine", "32 bits"],
)
def test_what_is_too_large_is_refused_before_anything_is_allocated(levels, limit, has):
    options = {} if limit is None else {"memory_limit": limit}
    error = refused(POINTS, FACES, levels, **options)
    assert error.code == "TOO_LARGE" and has in str(error)
