# SPDX-License-Identifier: GPL-3.0-or-later
"""Control vertices of many faces: time and memory grow with the number of faces."""

import discrete_fairing as df
import numpy as np
import pytest
import tight

FACES = (400, 800)


def disc(sides: int) -> tuple[np.ndarray, np.ndarray]:
    """Faces about one vertex, and a rim that waves."""
    angle = 2 * np.pi * np.arange(sides) / sides
    rim = np.stack([np.cos(angle), np.sin(angle), 0.1 * np.cos(3 * angle)], axis=1)
    k = np.arange(sides)
    return np.vstack([rim, [(0, 0, 0.3)]]), np.stack([k, (k + 1) % sides, 0 * k + sides], axis=1)


FREE = {"interpolation": "approximate", "tolerance": 0.02, "max_iterations": 20}
ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")


@pytest.mark.parametrize("options", [FREE, *({"energy": energy} for energy in ENERGIES)], ids=str)
@pytest.mark.parametrize("levels", [1, 2])
def test_memory_is_linear_in_valence(levels, options):
    peaks = [df.fair(*disc(n), levels, **options).report["peak_bytes"] for n in FACES]
    assert peaks[1] < 2.5 * peaks[0]


def test_a_large_ring_is_solved_as_a_small_one():
    """The surface hardly changes at the first ring that is too large for its points to be coupled directly."""
    few, many = (tight.fair(*disc(n), 2) for n in (64, 65))
    assert few.report["converged"] and many.report["converged"]
    assert few.vertices[64] == pytest.approx(many.vertices[65])
    energy = [r.report["energy"]["result"]["thin_plate"] for r in (few, many)]
    assert energy[1] == pytest.approx(energy[0], rel=0.05)


def test_level_beyond_the_direct_limit_is_solved():
    """Narrow levels have small factors; without one this takes minutes."""
    report = df.fair(*disc(2000), 3).report
    assert report["levels"][-1]["direct"] and report["converged"]
