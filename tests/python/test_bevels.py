# SPDX-License-Identifier: GPL-3.0-or-later
"""Pads on bevelled boxes: no surface swells beside the one on point forces."""

import bevelled_boxes
import discrete_fairing as df
import numpy as np
import pytest

EVERY = 7  # one box of so many
SWOLLEN = 1.02
BOXES = list(bevelled_boxes.family().items())[::EVERY]


def extents(mesh, levels: int) -> tuple[df.Result, float, float]:
    """The surface on pads; the extents of this surface and of the one on point forces, over those of the control
    mesh."""
    middle = (mesh[0].min(0) + mesh[0].max(0)) / 2
    pads, points = (df.fair(*mesh, levels, pad_size=size, measure=False) for size in (1.0, 0.0))
    own, *reached = (
        np.linalg.norm(vertices - middle, axis=1).max()
        for vertices in (mesh[0], pads.vertices, points.vertices)
    )
    return pads, *(each / own for each in reached)


def test_a_bevel_of_a_fiftieth_does_not_swell():
    """Pads that reached across each face once made this surface swell to many times the mesh."""
    mesh = bevelled_boxes.bevelled_box((1, 0.2, 0.1), 0.002)
    _, pads, points = extents(mesh, 1)
    assert pads <= SWOLLEN * max(points, 1)


@pytest.mark.parametrize("levels", [1, 2])
@pytest.mark.parametrize("sides, bevel", [pytest.param(*box, id=name) for name, box in BOXES])
def test_bevelled_boxes_do_not_swell(sides, bevel, levels):
    result, pads, points = extents(bevelled_boxes.bevelled_box(sides, bevel), levels)
    assert result.report["converged"]
    assert pads <= SWOLLEN * max(points, 1)
