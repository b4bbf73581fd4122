# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin faces: the smoother's lines keep iterations few, where levels had to be factored."""

import numpy as np
import pytest
import sliver_meshes as slivers
from control_meshes import random_hull
from discrete_fairing import fair

# Mesh, levels, the most iterations of the finest level with point forces. With the diagonal as the
# smoother, the two finest levels of all three were factored.
HARD = {
    "strips across the caps": (lambda: slivers.prism(), 3, 45),
    "fans from the rim": (lambda: slivers.prism(height=0.2, cap=slivers.rim_fan), 3, 45),
    "hull stretched by 100": (lambda: slivers.stretched(random_hull(400), 100), 3, 45),
}


def above_the_coarsest(result):
    """Reports of the levels that are too large for a direct solution."""
    return [level for level in result.report["levels"][1:] if level["unknowns"] > 1200]


@pytest.mark.parametrize("pad_size", [0, 1])
@pytest.mark.parametrize("name", HARD)
def test_no_level_is_factored(name, pad_size):
    make, levels, most = HARD[name]
    result = fair(*make(), levels, pad_size=pad_size, measure=False)
    hard = above_the_coarsest(result)
    assert len(hard) == 2
    assert all(level["converged"] and not level["direct"] for level in hard)
    assert hard[-1]["lines"]
    assert 0 < hard[-1]["iterations"] <= most


def test_lines_follow_weights():
    """A tolerance changes the weights of control vertices, and so the matrix, from round to round."""
    vertices, faces = slivers.stretched(random_hull(300), 30)
    result = fair(vertices, faces, 3, interpolation="approximate", tolerance=1e-2, measure=False)
    finest = result.report["levels"][-1]
    assert finest["converged"] and not finest["direct"]
    assert result.report["largest_deviation"] <= 1e-2 * (1 + 1e-9)


def test_lines_serve_total_curvature():
    """With the diagonal it took 78 iterations, of a degree that rose to forty."""
    hull = random_hull(40)  # 39,000 unknowns on level 5
    result = fair(*hull, 5, energy="total_curvature", measure=False)
    level = result.report["curvature"][-1]
    assert level["converged"] and not level["damped"]
    assert level["work"]["iterations"] <= 55
    radii = np.linalg.norm(result.vertices, axis=1)
    assert np.abs(radii / np.linalg.norm(hull[0][0]) - 1).max() < 1e-5
