# SPDX-License-Identifier: GPL-3.0-or-later
"""ease(): scatter goes, shapes stay, within what is asked for."""

import control_meshes
import discrete_fairing as df
import numpy as np
import pytest

SHAPES = {
    "bump": lambda x, y: 0.1 * np.exp(-6 * (x**2 + y**2)),
    "saddle": lambda x, y: 0.4 * (x**2 - y**2),
    "wave": lambda x, y: 0.05 * np.sin(4 * x + 2 * y + 3),
}
NOISE = 0.002


def sheet(shape="bump", across=9, along=7):
    """Quads on a smooth shape, 1 long; (vertices, faces, inner vertices)."""
    x, y = np.meshgrid(np.linspace(0, 1, across), np.linspace(0, 0.75, along), indexing="ij")
    z = SHAPES[shape](x - 0.5, y - 0.375)
    i, j = np.meshgrid(np.arange(across - 1), np.arange(along - 1), indexing="ij")
    a = (i * along + j).ravel()
    inner = np.arange(across * along).reshape(across, along)[1:-1, 1:-1].ravel()
    faces = np.stack([a, a + along, a + along + 1, a + 1], -1)
    return np.stack([x, y, z], -1).reshape(-1, 3), faces, inner


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


def test_scatter_is_read():
    truth, faces, inner = sheet("bump")
    noise = [df.ease(scattered(truth, inner, seed), faces).noise for seed in range(6)]
    assert abs(np.mean(noise) / NOISE - 1) < 0.25


def test_moves_stay_within_a_bound_and_use_it():
    truth, faces, inner = sheet()
    measured = scattered(truth, inner, 1)
    eased = df.ease(measured, faces, tolerance=NOISE)
    assert 0.99 * NOISE < eased.moves.max() <= NOISE
    bounds = np.full(len(truth), 10.0)
    bounds[inner[3]] = 1e-4
    assert df.ease(measured, faces, tolerance=bounds).moves[inner[3]] <= 1e-4


def test_the_planted_vertex_alone_goes_back():
    shares = []
    for seed in range(10):
        truth, faces, inner = sheet("saddle")
        measured = scattered(truth, inner, seed, NOISE / 3)
        vertex = np.random.default_rng(seed).choice(inner)
        measured[vertex, 2] += 4 * NOISE
        eased = df.ease(measured, faces, most=1)
        assert np.count_nonzero(eased.moves) == 1
        shares.append(eased.moves[vertex] / (4 * NOISE))
    assert abs(np.median(shares) - 1) < 0.15


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
        again.lengths[inner],
        eased.strain_after[inner],
        atol=0.1 * np.abs(eased.strain_before[inner]).max(),
    )


def test_shapes_without_scatter_stay():
    for points, faces in (control_meshes.cube(), control_meshes.torus(12, 8)):
        edge = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=-1).mean()
        assert df.ease(points, faces).moves.max() < 1e-2 * edge


def test_many_vertices_are_eased_without_all_eigenvalues():
    truth, faces, inner = sheet("wave", 27, 21)
    measured = scattered(truth, inner, 3)
    eased = df.ease(measured, faces, levels=1)
    assert error(eased.vertices, truth) < 0.5 * error(measured, truth)
    assert abs(eased.noise / NOISE - 1) < 0.1
    assert eased.iterations <= 31


def test_any_threads_give_the_same_bits():
    truth, faces, inner = sheet()
    measured = scattered(truth, inner, 4)
    one, two = (df.ease(measured, faces, threads=n) for n in (1, 2))
    assert np.array_equal(one.vertices, two.vertices) and one.noise == two.noise


@pytest.mark.parametrize(
    "settings, words",
    [
        ({"tolerance": -1.0}, "length"),
        ({"tolerance": [1.0, 2.0]}, "length"),
        ({"most": 0}, "from 1 on"),
        ({"most": 1, "tolerance": 1.0}, "exclude"),
        ({"fixed": [True]}, "bools"),
        ({"energy": "minimum_variation"}, "no pads"),
    ],
)
def test_bad_input_says_what_to_do(settings, words):
    with pytest.raises(df.FairingError, match=words) as caught:
        df.ease(*control_meshes.cube(), **settings)
    assert caught.value.code == "BAD_OPTION"


def test_it_can_be_cancelled():
    with pytest.raises(df.FairingError) as caught:
        df.ease(*control_meshes.torus(60, 40), progress=lambda *_: False)
    assert caught.value.code == "CANCELLED"
