# SPDX-License-Identifier: GPL-3.0-or-later
"""ease() removes scatter, keeps shapes and stays within its bounds."""

import control_meshes
import discrete_fairing as df
import numpy as np
import pytest
import scans
from lattices import lattice_faces
from test_strain import SHAPES, bump

NOISE = 0.002


def sheet(shape="bump", across=9, along=7):
    """Quads on a smooth shape, 1 long; (vertices, faces, inner vertices)."""
    points, faces, inner = bump(across, along)
    points[:, 2] = SHAPES[shape](points[:, 0] - 0.5, points[:, 1] - 0.375)
    return points, faces, inner


def scattered(points, inner, seed, noise=NOISE):
    measured = points.copy()
    measured[inner, 2] += noise * np.random.default_rng(seed).normal(size=len(inner))
    return measured


def error(points, truth):
    return np.sqrt(np.mean(np.sum((points - truth) ** 2, axis=1)))


@pytest.mark.parametrize("shape", SHAPES)
def test_scatter_goes_near_the_best_amount(shape):
    truth, faces, inner = sheet(shape)
    before, after, best = [], [], []
    for seed in range(4):
        measured = scattered(truth, inner, seed)
        before.append(error(measured, truth))
        after.append(error(df.ease(measured, faces).vertices, truth))
        bounds = NOISE * np.array([0.25, 0.5, 1, 1.5, 2, 3])
        best.append(
            min(error(df.ease(measured, faces, tolerance=b).vertices, truth) for b in bounds)
        )
    assert np.mean(after) < 0.8 * np.mean(before)
    assert np.mean(after) <= 1.2 * np.mean(best)


@pytest.mark.parametrize("shape", ["bump", "saddle"])
def test_a_bound_above_all_moves_changes_none(shape):
    """Once the border, whose scatter cannot be read, moved by the whole bound."""
    truth, faces, inner = sheet(shape)
    measured = scattered(truth, inner, 0)
    free = df.ease(measured, faces)
    for bound in (1.01 * free.moves.max(), 1e4 * NOISE):
        assert np.array_equal(df.ease(measured, faces, tolerance=bound).vertices, free.vertices)


def test_moves_stay_within_a_bound_and_use_it():
    truth, faces, inner = sheet()
    measured = scattered(truth, inner, 1)
    eased = df.ease(measured, faces, tolerance=NOISE)
    assert 0.99 * NOISE < eased.moves.max() <= NOISE
    bounds = np.full(len(truth), 10.0)
    bounds[inner[3]] = 1e-4
    assert df.ease(measured, faces, tolerance=bounds).moves[inner[3]] <= 1e-4


def test_strain_falls_and_what_is_held_stays():
    truth, faces, inner = sheet()
    measured = scattered(truth, inner, 2)
    fixed = np.zeros(len(truth), bool)
    fixed[inner[:5]] = True
    eased = df.ease(measured, faces, fixed=fixed)
    assert not eased.moves[fixed].any() and eased.moves[inner[5:]].all()
    before, after = (np.linalg.norm(s[inner]) for s in (eased.strain_before, eased.strain_after))
    assert after < 0.7 * before
    again = df.strain(eased.vertices, faces)
    np.testing.assert_allclose(
        again.excess[inner],
        eased.strain_after[inner],
        atol=0.1 * np.abs(eased.strain_before[inner]).max(),
    )


def test_shapes_without_scatter_stay():
    for points, faces in (control_meshes.cube(), control_meshes.torus(12, 8)):
        edge = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=-1).mean()
        assert df.ease(points, faces).moves.max() < 1e-2 * edge


def vase(rings=7, around=8):
    """Every other ring narrower; quads."""
    turn = 2 * np.pi * np.arange(around) / around
    radius = np.where(np.arange(rings) % 2, 1.2, 1.0)[:, None]
    height = np.broadcast_to(0.4 * np.arange(rings)[:, None], (rings, around))
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], -1).reshape(-1, 3)
    return points, lattice_faces(rings, around, (False, True))[:, [0, 3, 2, 1]]


@pytest.mark.parametrize("designed", [vase, control_meshes.tetrahedron])
def test_what_is_in_few_eigenvectors_is_no_scatter(designed):
    """Vertices once moved by a quarter and a fourteenth of an edge."""
    points, faces = designed()
    eased = df.ease(points, faces)
    assert (eased.amount, eased.moves.max()) == (0, 0)


def test_faint_scatter_is_not_made_worse_by_uneven_stars():
    truth, quads, inner = sheet("saddle")
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    before, after = [], []
    for seed in range(6):
        measured = truth.copy()
        measured[inner, 2] += 0.005 / 8 * np.random.default_rng(seed).normal(size=len(inner))
        before.append(error(measured, truth))
        after.append(error(df.ease(measured, triangles).vertices, truth))
    assert np.mean(after) < np.mean(before)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-2, 0.1])
def test_where_no_scatter_is_to_be_read_a_tolerance_is_used(tolerance):
    points, quads = control_meshes.cube()
    eased = df.ease(points, quads, tolerance=tolerance)
    assert 0.6 * tolerance < eased.moves.max() <= tolerance
    assert np.abs(eased.strain_after).max() < np.abs(eased.strain_before).max()
    held = np.full(len(points), tolerance)
    held[3] = 0
    assert df.ease(points, quads, tolerance=held).moves[3] == 0


def test_many_vertices_are_eased_without_all_eigenvalues():
    truth, faces, inner = sheet("wave", 27, 21)
    measured = scattered(truth, inner, 3)
    eased = df.ease(measured, faces, levels=1)
    assert error(eased.vertices, truth) < 0.5 * error(measured, truth)
    assert abs(eased.noise / NOISE - 1) < 0.1


def curved_sheet():
    """9 x 7 quads whose borders are cubics, which need no loads: (vertices, faces, border vertices)."""
    points, faces, inner = sheet("saddle")
    return points, faces, np.setdiff1d(np.arange(len(points)), inner)


def test_borders_are_eased_in_their_planes_and_corners_stay():
    truth, faces, border = curved_sheet()
    measured = truth.copy()
    corners = np.array([0, 6, 56, 62])
    rim = np.setdiff1d(border, corners)
    others = np.setdiff1d(np.arange(len(truth)), corners)
    measured[others, 2] += NOISE * np.random.default_rng(5).normal(size=len(others))
    eased = df.ease(measured, faces)
    assert not eased.moves[corners].any()
    assert error(eased.vertices[rim], truth[rim]) < 0.9 * error(measured[rim], truth[rim])
    across = np.repeat([1.0, 0.0], 7)  # x of the two borders across
    np.testing.assert_allclose(eased.vertices[[*range(56, 63), *range(7)], 0], across, atol=1e-12)


def test_a_border_without_scatter_inside_hardly_moves():
    truth, faces, border = curved_sheet()
    measured = truth.copy()
    measured[border, 2] += NOISE * np.random.default_rng(5).normal(size=len(border))
    assert df.ease(measured, faces).moves.max() < 0.5 * NOISE


def test_creases_are_eased_too():
    truth, faces, inner = sheet("saddle")
    crease = np.arange(4 * 7, 5 * 7)  # across the middle
    measured = truth.copy()
    measured[crease[3], 2] += 0.01
    edges = np.stack([crease[:-1], crease[1:]], -1)
    eased = df.ease(measured, faces, crease_edges=edges, most=1)
    assert set(np.flatnonzero(eased.moves)) == {crease[3]}
    np.testing.assert_allclose(eased.vertices[crease[3]], truth[crease[3]], atol=1e-3)


def test_the_worst_are_found_on_curves_and_off_them():
    truth, faces, inner = sheet("saddle")
    measured = truth.copy()
    off_curve, on_curve = inner[17], 3 * 7
    measured[off_curve, 2] += 0.01
    measured[on_curve, 2] -= 0.01
    eased = df.ease(measured, faces, most=2)
    assert set(np.flatnonzero(eased.moves)) == {off_curve, on_curve}
    assert error(eased.vertices, truth) < 0.15 * error(measured, truth)


def test_vertices_outside_a_region_stay():
    truth, faces, inner = sheet()
    measured = scattered(truth, inner, 6)
    region = np.flatnonzero(truth[faces][..., 0].mean(1) < 0.5)
    eased = df.ease(measured, faces, region=region)
    outside = np.setdiff1d(np.arange(len(truth)), faces[region])
    assert eased.moves.any() and not eased.moves[outside].any()


def test_half_a_mesh_is_eased_as_the_whole():
    points, faces = control_meshes.torus(12, 8)
    points = np.where(np.abs(points) < 1e-9, 0, points)
    points = points + 0.01 * np.abs(np.sin(40 * points[:, [1, 2, 1]] + [0.4, 0.9, 0.0])) * [0, 1, 1]
    image = np.linalg.norm(points[:, None] - points * [-1, 1, 1], axis=-1).argmin(1)
    np.testing.assert_allclose(points[image] * [-1, 1, 1], points, atol=1e-12)
    in_half = (points[faces][..., 0].min(1) > -1e-9).nonzero()[0]
    used, ids = np.unique(faces[in_half], return_inverse=True)
    for settings in ({}, {"tolerance": 0.003}):
        whole = df.ease(points, faces, **settings)
        half = df.ease(points[used], ids.reshape(-1, 4), symmetry_plane="x", **settings)
        np.testing.assert_allclose(
            half.vertices, whole.vertices[used], atol=0.05 * whole.moves.max()
        )
        assert not half.vertices[points[used, 0] == 0, 0].any()
    one = df.ease(points[used], ids.reshape(-1, 4), symmetry_plane="x", most=1)
    assert np.count_nonzero(one.moves) == 1


def dome_of_triangles(alternating, across=27):
    """Triangles with one diagonal or of 4 and 8 a vertex in turn, parameter lines drawn together; 2 wide."""
    at = np.linspace(-1, 1, across)
    at = at + 0.3 * np.sin(np.pi * at) / np.pi
    points, quads = scans.sheet(at, at, lambda x, y: 0.6 * (1 - x**2) * (1 - y**2))
    odd = (alternating * np.indices((across - 1, across - 1)).sum(axis=0) % 2 == 1).ravel()[:, None]
    first = np.where(odd, quads[:, [0, 1, 3]], quads[:, [0, 1, 2]])
    second = np.where(odd, quads[:, [1, 2, 3]], quads[:, [0, 2, 3]])
    return points, np.concatenate([first, second])


def two_hills(across, drawn):
    """Triangles of 4 and 8 a vertex in turn on two hills, parameter lines drawn together by `drawn`."""
    points, faces = dome_of_triangles(True, across)
    at = np.linspace(-1, 1, across)
    at = at + drawn * np.sin(np.pi * at) / np.pi
    x, y = (a.ravel() for a in np.meshgrid(at, at, indexing="ij"))
    z = 0.8 * np.exp(-6 * ((x + 0.3) ** 2 + (y + 0.1) ** 2))
    z += 0.5 * np.exp(-9 * ((x - 0.45) ** 2 + (y - 0.2) ** 2))
    return np.stack([x, y, z], -1), faces


@pytest.mark.parametrize(("across", "drawn"), [(13, 0.0), (13, 0.5), (13, 0.8), (17, 0.0)])
def test_exact_hills_of_alternating_triangles_stay(across, drawn):
    """Once moved by 14, 3.5, 5.5 and 12 thousandths of an edge: their curvature was taken for scatter."""
    points, faces = two_hills(across, drawn)
    edge = 2 / (across - 1)
    assert df.ease(points, faces).moves.max() < 2e-3 * edge
    inner = np.flatnonzero((np.abs(points[:, :2]) < 0.999).all(axis=1))
    measured = scattered(points, inner, 1, 0.05 * edge)
    assert error(df.ease(measured, faces).vertices, points) < 0.95 * error(measured, points)


@pytest.mark.parametrize("alternating", [True, False])
def test_strain_of_an_exact_dome_is_no_scatter(alternating):
    """Its vertices once moved by half an edge, later those beside corners by a hundredth."""
    points, faces = dome_of_triangles(alternating)
    edge = 2 / 26
    assert df.ease(points, faces).moves.max() < 2e-3 * edge
    inner = np.flatnonzero((np.abs(points[:, :2]) < 0.999).all(axis=1))
    measured = scattered(points, inner, 1, 0.05 * edge)
    eased = df.ease(measured, faces)
    assert error(eased.vertices, points) < 0.6 * error(measured, points)
