# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets with only one side: the thin plate fairs them as it does their double covers."""

import discrete_fairing as df
import numpy as np
import pytest
from one_sided_meshes import core, klein_bottle, strip
from surfaces import euler_characteristic, output_faces
from test_sheets import assert_welded, corners_of
from tight import fair

AROUND, ACROSS = 9, 2


def cases(triangles=False):
    return (strip(AROUND, ACROSS, triangles), strip(AROUND, ACROSS, triangles, cover=True))


def assert_half_of(one, two, faces, tolerance=1e-9):
    own = np.arange(faces)
    assert np.abs(corners_of(one, own) - corners_of(two, own)).max() <= tolerance


def on_cover(edges):
    """Edges of the strip on its cover: a vertex (i, j) is at (i, j) and at (i + around, -j)."""
    row, column = np.divmod(np.asarray(edges), ACROSS + 1)
    over = (row + AROUND) * (ACROSS + 1) + ACROSS - column
    at = [np.asarray(edges), over]
    pairs = np.concatenate([np.stack([a[:, 0], b[:, 1]], -1) for a in at for b in at])
    rows = pairs // (ACROSS + 1)
    apart = np.abs(rows[:, 0] - rows[:, 1])
    return pairs[np.minimum(apart, 2 * AROUND - apart) <= 1]


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("levels", [0, 1, 3])
def test_a_strip_is_half_its_double_cover(triangles, levels):
    (vertices, faces), cover = cases(triangles)
    result = fair(vertices, faces, levels, relative_residual=1e-12)
    assert result.report["converged"]
    assert_welded(result, vertices, faces)
    assert result.report["sheets"]["one_sided"] == result.report["sheets"]["count"] == 1
    assert [w["code"] for w in result.report["warnings"]] == ["NON_ORIENTABLE"]
    twice = fair(*cover, levels, relative_residual=1e-12)
    assert_half_of(result, twice, len(faces))
    for part in ("result", "polyhedron"):
        for name, whole in twice.report["energy"][part].items():
            assert result.report["energy"][part][name] == pytest.approx(whole / 2, rel=1e-6)


@pytest.mark.parametrize(
    "options",
    [
        {"pad_size": 1.0},
        {"boundary": "free"},
        {"boundary": "linear", "pad_size": 1.0},
        {"corner_vertices": [0, 4]},
        {"crease_angle": 0.3, "corner_angle": 0.5},
        {"tension": 0.5},
        {"epsilon": 0.1},
        {"interpolation": "approximate", "tolerance": 0.1, "pad_size": 1.0},
    ],
    ids=lambda options: "-".join(options),
)
def test_with_all_options(options):
    (vertices, faces), cover = cases()
    twice = dict(options)
    if "corner_vertices" in options:
        corners = np.array(options["corner_vertices"])
        twice["corner_vertices"] = np.unique(on_cover(np.stack([corners, corners], -1)))
    result = fair(vertices, faces, 2, **options)
    assert result.report["converged"]
    assert_half_of(result, fair(*cover, 2, **twice), len(faces), 1e-4)
    moves = "epsilon" in options or "tolerance" in options
    moved = np.linalg.norm(result.vertices[: len(vertices)] - vertices, axis=1)
    assert moved.max() <= 0.1 and (moved.max() > 1e-3) == moves


def test_a_crease_that_goes_around_once():
    (vertices, faces), cover = cases()
    middle = core(AROUND, ACROSS)
    result = fair(vertices, faces, 3, crease_edges=middle)
    assert sorted(map(sorted, result.crease_edges.tolist())) == sorted(map(sorted, middle.tolist()))
    assert_half_of(result, fair(*cover, 3, crease_edges=on_cover(middle)), len(faces), 1e-7)
    # a closed curve, smooth all around
    smooth = fair(vertices, faces, 3)
    assert not np.array_equal(result.vertices, smooth.vertices)


def test_a_closed_one_with_polygons():
    vertices, quads = klein_bottle()
    result = fair(vertices, quads, 2)
    assert_welded(result, vertices, quads)
    assert result.report["sheets"]["one_sided"] == 1 and euler_characteristic(quads.tolist()) == 0
    # two quads as a hexagon, which is split around its centre
    a, b = quads[0], quads[6]
    hexagon = [a[0], a[1], b[1], b[2], a[2], a[3]]
    assert set(a) & set(b) == {a[1], a[2]}
    faces = [hexagon, *np.delete(quads, [0, 6], 0).tolist()]
    split = fair(vertices, faces, 2)
    fine = output_faces(split)
    assert euler_characteristic(fine) == 0
    assert np.array_equal(np.unique(np.concatenate(fine)), np.arange(len(split.vertices)))
    assert len(split.vertices) == df.predicted_size(len(vertices), faces, 2)["vertices"]


@pytest.mark.parametrize("energy", ["total_curvature", "minimum_variation"])
@pytest.mark.parametrize("repair", ["refuse", "mend"])
def test_other_energies_say_why_not(energy, repair):
    vertices, faces = strip(7, 1)
    with pytest.raises(df.FairingError, match="one side, like a Möbius strip. Only the thin") as e:
        df.fair(vertices, faces, 2, energy, repair=repair)
    assert (e.value.code, e.value.elements) == ("NON_ORIENTABLE", list(range(7)))
