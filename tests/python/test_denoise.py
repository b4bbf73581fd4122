# SPDX-License-Identifier: GPL-3.0-or-later
"""denoise(): as near to the truth as Taubin's filter at its best, and spikes are rejected."""

import discrete_fairing as df
import numpy as np
import pytest
from lattices import lattice_faces

NOISE = 0.1  # of an edge, rms


def sheet(across, height):
    """Triangles of unit edges in the plane, and what `height` of x and y makes of them; (truth, faces)."""
    i, j = np.meshgrid(np.arange(across), np.arange(across), indexing="ij")
    x = (i + 0.5 * (j % 2)).ravel() - across / 2
    y = (j * np.sqrt(0.75)).ravel() - across * np.sqrt(0.75) / 2
    a = (i * across + j)[:-1, :-1].ravel()
    even = (j[:-1, :-1].ravel() % 2 == 0)[:, None]
    lower = np.where(even, [0, across, 1], [0, across, across + 1])
    upper = np.where(even, [across, across + 1, 1], [0, across + 1, 1])
    faces = np.concatenate([a[:, None] + lower, a[:, None] + upper])
    return np.stack([x, y, height(x, y)], -1), faces


def smooth_and_detailed(x, y):
    """A wide hill, and ripples of seven edges on a third of it."""
    ripples = 0.4 * np.sin(0.9 * x) / (1 + np.exp(10 - x))
    return 8 * np.exp(-(x**2 + y**2) / 500) + ripples


def sphere(x, y):
    return np.sqrt(90.0**2 - x**2 - y**2)


def noisy(truth, seed=1, size=NOISE):
    measured = truth.copy()
    measured[:, 2] += size * np.random.default_rng(seed).normal(size=len(truth))
    return measured


def error(points, truth, chosen=slice(None)):
    """Heights off the truth, rms: vertices that have moved aside are compared where they are."""
    return np.sqrt(np.mean((points - truth)[chosen, 2] ** 2))


def inside(truth):
    return (np.abs(truth[:, :2]) < 26).all(axis=1)


@pytest.mark.parametrize("shape, best", [(smooth_and_detailed, 0.0375), (sphere, 0.0287)])
def test_as_near_to_the_truth_as_taubin_with_the_steps_that_suit_best(shape, best):
    """His filter with lambda 0.5 and mu -0.53 [Taubin 1995] is best after 16 and 64 steps."""
    truth, faces = sheet(70, shape)
    found = df.denoise(noisy(truth), faces)
    assert error(found.vertices, truth, inside(truth)) < 1.1 * best


@pytest.mark.parametrize("size", [0.02, 0.1])
def test_the_noise_is_read(size):
    truth, faces = sheet(70, smooth_and_detailed)
    assert df.denoise(noisy(truth, 2, size), faces).noise == pytest.approx(size, rel=0.15)


def test_spikes_are_rejected_and_go():
    truth, faces = sheet(50, lambda x, y: 0.01 * x * y)
    measured = noisy(truth)
    spikes = np.flatnonzero(inside(truth) & (np.abs(truth[:, :2]) < 18).all(axis=1))[::97]
    measured[spikes, 2] += 1.5
    found = df.denoise(measured, faces)
    assert set(found.rejected.tolist()) == set(spikes.tolist())
    assert error(found.vertices, truth, spikes) < 0.1


def test_vertices_move_along_their_normals_and_fixed_ones_stay():
    truth, faces = sheet(30, lambda x, y: np.zeros_like(x))
    measured = noisy(truth)
    fixed = truth[:, 0] < 0
    found = df.denoise(measured, faces, fixed=fixed)
    assert not found.moves[fixed].any() and found.moves[~fixed & inside(truth)].any()
    way = found.vertices - measured
    assert np.abs(way[:, :2]).max() < 0.2 * np.abs(way[:, 2]).max()
    assert np.array_equal(found.moves, np.linalg.norm(way, axis=1)) or np.allclose(
        found.moves, np.linalg.norm(way, axis=1), atol=1e-12
    )


def test_what_is_exact_stays():
    truth, faces = sheet(30, lambda x, y: 0.0 * x)
    found = df.denoise(truth, faces)
    assert found.moves.max() < 1e-12 and not len(found.rejected)


def test_a_larger_amount_takes_more_off():
    truth, faces = sheet(40, lambda x, y: np.sin(0.8 * x))
    small, large = (df.denoise(truth, faces, amount=amount).moves for amount in (0.01, 1.0))
    assert small.max() < 0.1 < large.max()


def test_corners_of_a_border_stay_and_polygons_will_do():
    x, y = np.meshgrid(np.arange(12.0), np.arange(12.0), indexing="ij")
    truth = np.stack([x, y, 0 * x], -1).reshape(-1, 3)
    found = df.denoise(noisy(truth), lattice_faces(12, 12).tolist())
    assert not found.moves[[0, 11, 132, 143]].any()
    assert error(found.vertices, truth) < 0.6 * NOISE


def test_nothing_is_denoised_to_nothing():
    assert len(df.denoise(np.empty((0, 3)), np.empty((0, 3), int)).vertices) == 0
