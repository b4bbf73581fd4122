# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin faces: the smoother's lines keep iterations few, where levels had to be factored."""

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
