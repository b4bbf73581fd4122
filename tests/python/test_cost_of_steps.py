# SPDX-License-Identifier: GPL-3.0-or-later
"""What the default residual leaves of total curvature on pads."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from surfaces import size_of


def fair(name, **options):
    mesh = meshes.torus(10, 8) if name == "torus" else getattr(meshes, name)()
    return df.fair(*mesh, levels=3, energy="total_curvature", **options)


@pytest.mark.parametrize("name", ["icosahedron", "torus", "creature"])
def test_what_is_left_cannot_be_seen(name):
    usual, exact = fair(name), fair(name, relative_residual=1e-8)
    farthest = np.linalg.norm(usual.vertices - exact.vertices, axis=1).max()
    assert farthest <= 1e-4 * size_of(exact.vertices)
    corners = [r.vertices[r.triangles] for r in (usual, exact)]
    normals = [np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]) for c in corners]
    units = [n / np.linalg.norm(n, axis=1)[:, None] for n in normals]
    turned = 2 * np.arcsin(np.linalg.norm(units[0] - units[1], axis=1) / 2)
    assert np.degrees(turned).max() <= 0.05
