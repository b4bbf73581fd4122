# SPDX-License-Identifier: GPL-3.0-or-later
"""Tension: what a membrane beside the bending does to a surface, and what it leaves alone."""

import control_meshes as meshes
import numpy as np
import pytest
import tight

CLOSED = ("octahedron", "cube", "torus", "creature", "mixed_house", "dodecahedron", "three_handles")
ENERGIES = ("thin_plate", "total_curvature")


def mesh_of(name):
    return getattr(meshes, name)()


def volume(result):
    corner = result.vertices[result.triangles]
    return np.einsum("fi,fi->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6


def area(result):
    corner = result.vertices[result.triangles]
    return (
        np.linalg.norm(
            np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
        ).sum()
        / 2
    )


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("name", CLOSED)
def test_area_falls_and_the_surface_passes_through_every_vertex(name, energy):
    """On a cube and on handles with tension 1, steps between point forces do not settle, and say so."""
    vertices, faces = mesh_of(name)
    found = {
        tension: tight.fair(vertices, faces, levels=2, energy=energy, tension=tension)
        for tension in (0, 0.25, 0.5, 0.75, 1)
    }
    areas = [area(result) for result in found.values()]
    assert areas == sorted(areas, reverse=True)
    for tension, result in found.items():
        assert np.array_equal(result.vertices[: len(vertices)], vertices)
        told = any(
            warning["code"].startswith("NOT_CONVERGED") for warning in result.report["warnings"]
        )
        assert result.report["converged"] != told
        assert not told or (tension == 1 and energy == "total_curvature")


@pytest.mark.parametrize("name", ("icosahedron", "octahedron", "cube", "random_hull"))
def test_spheres_flatten_towards_their_hulls(name):
    vertices, faces = mesh_of(name)
    vertices = vertices / np.linalg.norm(vertices, axis=1)[:, None]
    round_, taut = (
        tight.fair(vertices, faces, levels=3, energy="total_curvature", tension=t) for t in (0, 0.5)
    )
    assert np.array_equal(taut.vertices[: len(vertices)], vertices)
    assert taut.report["converged"]
    assert np.abs(np.linalg.norm(round_.vertices, axis=1) - 1).max() < 1e-4
    assert volume(tight.fair(vertices, faces, levels=0)) < volume(taut) < volume(round_)
