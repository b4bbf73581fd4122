# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft creases: the surface turns within their radius, in one hump, and less and less at any one place."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from surface_measures import turns

COLUMNS, ROWS = 8, 10
CENTRE = COLUMNS // 2


def sheet(height):
    """A grid about x = 0 of unit squares, with z = height(x, y)."""
    points, faces = meshes.grid(COLUMNS, ROWS)
    points = points - [CENTRE, 0, 0]
    points[:, 2] = height(points[:, 0], points[:, 1])
    return points, faces


def line(count=ROWS):
    """(count, 2): the first edges on x = 0."""
    on = np.arange(count + 1) * (COLUMNS + 1) + CENTRE
    return np.stack([on[:-1], on[1:]], axis=1)


def roof():
    return sheet(lambda x, y: -0.3 * np.abs(x))


def bonnet():
    """A dome with a feature line on its middle that fades over five edges."""
    return sheet(
        lambda x, y: -0.02 * x**2 - 0.01 * (y - 5) ** 2 - 0.04 * np.abs(x) * np.clip(5 - y, 0, None)
    )


WEIGHTS = [1.0, 0.8, 0.6, 0.4, 0.2]


def section(result, y):
    """(places, curvatures) of the polyline across the sheet at `y`."""
    count = COLUMNS << result.report["levels"][-1]["level"]
    near = np.argsort(np.abs(result.vertices[:, 1] - y), kind="stable")[: count + 1]
    points = result.vertices[near]
    points = points[np.argsort(points[:, 0])][:, [0, 2]]
    steps = np.diff(points, axis=0)
    lengths = np.hypot(*steps.T)
    angles = np.arctan2(steps[:, 1], steps[:, 0])
    return points[1:-1, 0], -np.diff(angles) / (0.5 * (lengths[1:] + lengths[:-1]))


def width(x, curvature):
    """The width of the part about 0 where curvature is above half of its largest."""
    top = curvature.max() / 2
    above = np.flatnonzero(curvature > top)
    assert np.array_equal(above, np.arange(above[0], above[-1] + 1))  # one hump
    i, j = above[0], above[-1]
    left = np.interp(top, curvature[[i - 1, i]], x[[i - 1, i]])
    right = np.interp(-top, -curvature[[j, j + 1]], x[[j, j + 1]])
    return right - left


@pytest.mark.parametrize("cut", [False, True])
@pytest.mark.parametrize("weight", [0.3, 0.5, 0.7])
def test_the_turn_is_one_hump_as_wide_as_the_radius(weight, cut):
    points, faces = roof()
    if cut:
        points, faces = meshes.cut_quads((points, faces))
    found = df.fair(points, faces, levels=5, soft_creases=(line(), weight))
    x, curvature = section(found, ROWS / 2 + (0 if cut else 0.5))
    assert width(x, curvature) == pytest.approx(1 - weight, rel=0.2)
    plain = section(df.fair(points, faces, levels=5), ROWS / 2 + (0 if cut else 0.5))[1]
    near = np.abs(x) < 2
    assert -curvature[near].min() < 0.7 * -plain[near].min()  # less swing back beside it


def largest_turns(found):
    """The largest turn beside each edge of the feature line, and elsewhere off the border."""
    quads = found.faces[1]
    triangles = np.concatenate([found.faces[0], quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    edges, _, angles = turns(found.vertices, triangles)
    places, angles = found.vertices[edges].mean(axis=1), np.degrees(angles)
    on = np.abs(places[:, 0]) < 0.5
    beside = [angles[on & (places[:, 1] > k) & (places[:, 1] < k + 1)].max() for k in range(ROWS)]
    return np.array([*beside, angles[~on].max()])


def test_a_feature_line_that_fades_folds_nowhere_but_where_it_is_sharp():
    points, faces = bonnet()
    levels = [
        largest_turns(df.fair(points, faces, levels=level, soft_creases=(line(5), WEIGHTS)))
        for level in (3, 4, 5)
    ]
    for coarse, fine in zip(levels, levels[1:]):
        assert fine[0] > 0.95 * coarse[0]  # sharp
        assert (fine[2:] < 0.75 * coarse[2:]).all()
    assert (levels[2][2:] < 3).all()


@pytest.mark.parametrize("energy, rel", [("total_curvature", 0.2), ("minimum_variation", 0.2)])
def test_other_energies_turn_within_the_radius_too(energy, rel):
    found = df.fair(*roof(), levels=4, energy=energy, soft_creases=(line(), 0.5))
    assert not found.report["warnings"]
    assert width(*section(found, ROWS / 2 + 0.5)) == pytest.approx(0.5, rel=rel)


def test_control_vertices_stay_and_weights_of_nothing_and_one_are_as_ever():
    points, faces = bonnet()
    found = df.fair(points, faces, levels=3, soft_creases=(line(5), WEIGHTS))
    assert np.array_equal(found.vertices[: len(points)], points)
    assert found.crease_edges.tolist() == line(1).tolist()
    plain = df.fair(points, faces, levels=3).vertices
    assert np.array_equal(df.fair(points, faces, soft_creases=(line(), 0.0)).vertices, plain)
    sharp = df.fair(points, faces, levels=3, crease_edges=line()).vertices
    assert np.array_equal(df.fair(points, faces, soft_creases=(line(), 1.0)).vertices, sharp)


@pytest.mark.parametrize("weight", [0.3, 0.5])
def test_one_patch_of_a_sheet_follows_the_turn(weight):
    patches = df.fit_patches(*roof(), soft_creases=(line(), weight))
    assert len(patches) == 1 and not len(patches.unmet)


def test_patches_across_a_fading_crease_miss_at_most_where_it_becomes_soft():
    patches = df.fit_patches(*bonnet(), levels=5, soft_creases=(line(5), WEIGHTS))
    assert not len(patches.unresolved)
    assert set(patches.unmet) <= {CENTRE - 1, CENTRE, CENTRE - 1 + COLUMNS, CENTRE + COLUMNS}


def test_any_number_of_threads_pieces_a_solver_and_a_mended_mesh_give_the_same():
    points, faces = bonnet()
    given = {"levels": 3, "soft_creases": (line(5), WEIGHTS)}
    found = df.fair(points, faces, **given).vertices
    assert np.array_equal(df.fair(points, faces, threads=3, **given).vertices, found)
    solver = df.Solver(points, faces, **given)
    solver.solve(points + [0, 0, 0.1] * (points[:, :1] > 2))
    assert np.abs(solver.solve(points).vertices - found).max() < 1e-3
    parts = [piece.fair() for piece in df.pieces(points, faces, count=2, rings=4, **given)]
    assert np.abs(df.join(parts).vertices - found).max() < 1e-3
    twice = np.concatenate([faces, faces[:1]])
    mended = df.fair(points, twice, repair="mend", **given).vertices
    assert np.abs(mended - found).max() < 1e-12
