# SPDX-License-Identifier: GPL-3.0-or-later
"""Control vertices of many faces: time and memory grow with the number of faces."""

import discrete_fairing as df
import pytest
import tight
from control_meshes import fan

FACES = (400, 800)


FREE = {"interpolation": "approximate", "tolerance": 0.02, "max_iterations": 20}
ENERGIES = ("thin_plate", "total_curvature", "minimum_variation")


@pytest.mark.parametrize("options", [FREE, *({"energy": energy} for energy in ENERGIES)], ids=str)
@pytest.mark.parametrize("levels", [1, 2])
def test_memory_is_linear_in_valence(levels, options):
    peaks = [df.fair(*fan(n), levels, **options).report["peak_bytes"] for n in FACES]
    assert peaks[1] < 2.5 * peaks[0]


def test_a_large_ring_is_solved_as_a_small_one():
    """The surface hardly changes at the first ring that is too large for its points to be coupled directly."""
    few, many = (tight.fair(*fan(n), 2) for n in (64, 65))
    assert few.report["converged"] and many.report["converged"]
    assert few.vertices[0] == pytest.approx(many.vertices[0])
    energy = [r.report["energy"]["result"]["thin_plate"] for r in (few, many)]
    assert energy[1] == pytest.approx(energy[0], rel=0.05)
