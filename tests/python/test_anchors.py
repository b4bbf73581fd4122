# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface needs something that holds it."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest


def test_weights_that_leave_a_closed_surface_nowhere_to_be():
    """Nothing holds it: any one point would do, and that is no surface."""
    with pytest.raises(df.FairingError) as caught:
        df.fair(*meshes.icosahedron(), 2, interpolation="approximate", weights=np.zeros(12))
    assert caught.value.code == "UNDERDETERMINED" and caught.value.elements == list(range(12))


def test_back_leg_interpolates_only():
    with pytest.raises(df.FairingError, match="back_leg"):
        df.fair(*meshes.cube(), 2, method="back_leg", interpolation="approximate", tolerance=0.1)


def test_a_flat_mesh_with_a_tolerance_has_nothing_to_settle():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    report = df.fair(
        vertices, [[0, 1, 2, 3]], 2, boundary="free", interpolation="approximate", tolerance=0.1
    ).report
    assert report["constraint_gap"] <= 1e-3 and report["largest_deviation"] <= 1e-9


def test_creases_come_back_by_whatever_rule():
    vertices, faces = meshes.cube()
    result = df.fair(vertices, faces, 2, crease_angle=1.0)
    assert len(result.crease_edges) == 12
    assert not len(df.fair(vertices, faces, 2).crease_edges)
