# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature and folds of surfaces whose answer is known, and how the error shrinks."""

from dataclasses import replace

import numpy as np
import pytest
from lattices import lattice_faces
from polygons import polygons
from scans import cube_sphere

from addon.inspection import curvature


def grid(shape, n, m, close_u, close_v, diagonals=True):
    """`shape(u, v)` of parameters in [0, 1), sampled n × m, in triangles or quads with the normal along ∂u × ∂v."""
    u = np.arange(n) / (n if close_u else n - 1)
    v = np.arange(m) / (m if close_v else m - 1)
    positions = np.stack(shape(*np.meshgrid(u, v, indexing="ij")), axis=-1).reshape(-1, 3)
    faces = lattice_faces(n, m, (close_u, close_v))
    return polygons(positions, faces[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3) if diagonals else faces)


def torus(n, diagonals=False):
    """Radii 2 and 1, n around the tube; quads."""

    def shape(u, v):
        u, v = 2 * np.pi * u, 2 * np.pi * v
        r = 2 + np.cos(v)
        return r * np.cos(u), r * np.sin(u), np.sin(v)

    return grid(shape, 2 * n, n, True, True, diagonals)


def torus_truth(positions):
    r = np.hypot(positions[:, 0], positions[:, 1])
    across = (r - 2) / r
    return (1 + across) / 2, across


def sphere(levels):
    """Quads, with corners where three meet."""
    return polygons(*cube_sphere(2**levels))


def test_inside_out_sphere_is_hollow():
    ball = sphere(3)
    inside_out = replace(ball, corners=ball.corners.reshape(-1, 4)[:, ::-1].ravel())
    bent = curvature.curvature(inside_out)
    assert (bent.mean < -0.9).all() and (bent.gauss > 0.9).all()
    assert (bent.total * bent.area).sum() == pytest.approx(8 * np.pi, rel=0.03)


def test_gauss_bonnet_to_the_last_digits():
    for shape, euler in ((sphere(3), 2), (torus(12), 0)):
        bent = curvature.curvature(shape)
        assert (bent.gauss * bent.area).sum() == pytest.approx(2 * np.pi * euler, abs=1e-9)


@pytest.mark.parametrize("diagonals", [False, True])
def test_torus_converges_with_the_square_of_the_edges(diagonals):
    errors = []
    for n in (16, 32, 64):
        mesh = torus(n, diagonals)
        mean, gauss = torus_truth(mesh.positions)
        bent = curvature.curvature(mesh)
        errors.append([np.abs(bent.mean - mean).max(), np.abs(bent.gauss - gauss).max()])
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert orders.min() > 1.8, orders
    assert np.max(errors[-1]) < 0.01


def test_cylinder_and_its_open_ends():
    def shape(u, v):
        return 0.5 * np.cos(2 * np.pi * u), 0.5 * np.sin(2 * np.pi * u), v

    mesh = grid(shape, 64, 9, True, False)
    bent = curvature.curvature(mesh)
    # 1 / 2r, on the rims too: taken from their neighbours
    assert np.abs(bent.mean - 1.0).max() < 1e-3
    assert np.abs(bent.gauss).max() < 1e-9
    assert (~bent.inner).sum() == 2 * 64


def test_curvature_stops_at_sharp_edges():
    positions = [(x, y, x == 2 and y > 0) for y in range(3) for x in range(3)]
    faces = [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)]
    inner = curvature.curvature(polygons(positions, faces)).inner
    assert np.flatnonzero(inner).tolist() == [4]
    bent = curvature.curvature(polygons(positions, faces, [(1, 4), (4, 7)]))
    assert not bent.inner.any() and not bent.mean.any()


DART = np.array([(0, 0), (2, -1), (0.5, 0), (2, 1)])
ONCE = {"long": ([(0, 0), (3, -1), (6, 0), (3, 1)], {1, 3})}  # and its shorter diagonal
ONCE |= {f"dent at {t}": (np.roll(DART, t, axis=0), {t % 4, (t + 2) % 4}) for t in range(4)}


@pytest.mark.parametrize("quad", ONCE)
def test_quads_are_halved_along_a_diagonal_inside(quad):
    points, diagonal = ONCE[quad]
    triangles, weights = curvature.triangulate(
        np.c_[points, np.zeros(4)], np.arange(4), np.array([0, 4])
    )
    assert len(triangles) == 2 and all(diagonal <= set(t) for t in triangles.tolist())
    assert weights.tolist() == [1.0, 1.0]


def test_a_square_is_halved_both_ways_larger_polygons_become_fans_and_lines_nothing():
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    triangles, weights = curvature.triangulate(square, np.arange(4), np.array([0, 4]))
    assert sorted(map(sorted, triangles.tolist())) == [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    assert weights.tolist() == [0.5] * 4
    corners, offsets = np.array([0, 1, 2, 3, 4, 5, 0, 1, 3, 4, 5]), np.array([0, 6, 8, 11])
    triangles, weights = curvature.triangulate(np.zeros((6, 3)), corners, offsets)
    fan = [[0, k, k + 1] for k in (1, 2, 3, 4)]
    assert sorted(triangles.tolist()) == [*fan, [3, 4, 5]] and weights.tolist() == [1.0] * 5


def test_degenerate_faces_give_finite_numbers():
    positions = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (0, 0, 0), (0, 0, 0)]
    mesh = polygons(positions, [(0, 1, 2), (0, 1, 3), (0, 4, 5), (2, 1, 3)])
    bent = curvature.curvature(mesh)
    assert np.isfinite(bent.mean).all() and np.isfinite(bent.gauss).all()
