# SPDX-License-Identifier: GPL-3.0-or-later
"""Total curvature with its control vertices on pads, and minimum variation that starts from it."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight
from surfaces import size_of


def energy(result):
    return result.report["energy"]["result"]["total_curvature"] / (8 * np.pi)


def fair(mesh, **options):
    return tight.fair(*mesh, energy="total_curvature", measure=True, **options)


@pytest.mark.parametrize("size", (0.5, 1.0))
@pytest.mark.parametrize("name", ("octahedron", "cube", "icosahedron", "dodecahedron"))
def test_points_on_a_sphere_still_give_that_sphere(name, size):
    vertices, faces = getattr(meshes, name)()
    needles, pads = (fair((vertices, faces), levels=3, pad_size=s) for s in (0, size))
    assert np.array_equal(pads.vertices[: len(vertices)], vertices)
    assert pads.report["curvature"][-1]["converged"]
    assert energy(pads) <= 1.001 * energy(needles)
    radius = np.linalg.norm(vertices[0])
    assert abs(np.linalg.norm(pads.vertices, axis=1) - radius).max() < 2e-2 * radius


@pytest.mark.parametrize("name", ["icosahedron", "torus", "creature"])
def test_what_is_left_cannot_be_seen(name):
    """Steps with default tolerances leave it."""
    mesh = meshes.torus(10, 8) if name == "torus" else getattr(meshes, name)()
    usual, exact = (
        df.fair(*mesh, 3, "total_curvature", **options)
        for options in ({}, {"relative_residual": 1e-8})
    )
    farthest = np.linalg.norm(usual.vertices - exact.vertices, axis=1).max()
    assert farthest <= 1e-4 * size_of(exact.vertices)
    corners = [r.vertices[r.triangles] for r in (usual, exact)]
    normals = [np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]) for c in corners]
    units = [n / np.linalg.norm(n, axis=1)[:, None] for n in normals]
    turned = 2 * np.arcsin(np.linalg.norm(units[0] - units[1], axis=1) / 2)
    assert np.degrees(turned).max() <= 0.05
