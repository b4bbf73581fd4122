# SPDX-License-Identifier: GPL-3.0-or-later
"""The variation of curvature: spheres have none, and no peak is left at the control vertices."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import sliver_meshes
import tight
from lattices import lattice_faces


def on_unit_sphere(mesh):
    vertices, faces = mesh
    vertices = np.asarray(vertices, float)
    return vertices / np.linalg.norm(vertices, axis=1)[:, None], faces


def finest(result):
    return result.report["curvature"][-1]


@pytest.mark.parametrize("levels", [2, 3])
@pytest.mark.parametrize(
    "name", ["tetrahedron", "octahedron", "icosahedron", "cube", "random_hull"]
)
def test_inscribed_meshes_become_spheres(name, levels):
    result = tight.fair(*on_unit_sphere(meshes.ALL[name]()), levels, "minimum_variation")
    assert np.abs(np.linalg.norm(result.vertices, axis=1) - 1).max() < 1e-5
    assert finest(result)["converged"]


@pytest.mark.parametrize("name", ["creature", "torus_quads", "wavy_patch"])
def test_variation_falls_and_total_curvature_started_it(name):
    vertices, faces = meshes.ALL[name]()
    result = tight.fair(vertices, faces, 2, "minimum_variation")
    report = finest(result)
    assert 0 < report["variation"] < report["start_variation"]
    assert np.isfinite(result.vertices).all()
    assert np.array_equal(result.vertices[: len(vertices)], np.asarray(vertices, float))
    kinds = [step["functional"] for step in report["steps"]]
    assert kinds == sorted(kinds, reverse=True) and kinds[-1] == "minimum_variation"


def test_steps_go_on_while_solves_are_unfinished():
    """On a torus in strips between creases, solves end by their limit of iterations."""
    strips = {"levels": 4, "crease_angle": np.radians(40)}
    report = finest(df.fair(*meshes.torus(), energy="minimum_variation", **strips))
    assert report["converged"]
    assert report["variation"] < 3.3


def test_a_patch_of_a_sphere_is_found():
    """Six by six quads on a sphere, whose borders do not lie on it: the middle is compared."""
    at = np.linspace(-0.6, 0.6, 7)
    vertices = np.array([(x, y, np.sqrt(1 - x * x - y * y)) for x in at for y in at])
    faces = lattice_faces(7, 7)

    def error(energy):
        points = tight.fair(vertices, faces, 3, energy).vertices
        middle = points[(np.abs(points[:, :2]) < 0.31).all(axis=1)]
        return np.abs(np.linalg.norm(middle, axis=1) - 1).max()

    assert error("minimum_variation") < 5e-5 < 5e-4 < error("total_curvature") < error("thin_plate")


def test_a_flat_mesh_stays_flat():
    vertices, faces = meshes.flat_patch()
    result = tight.fair(vertices, faces, 2, "minimum_variation")
    assert np.abs(result.vertices[:, 2] - result.vertices[0, 2]).max() < 1e-12


def plate_with_hole(count):
    """Flat, with long thin triangles from the corners to the vertices of a round hole."""
    turn = 2 * np.pi * np.arange(count) / count
    hole = np.c_[0.3 + 0.4 * np.cos(turn), 0.1 + 0.4 * np.sin(turn)]
    flat = np.concatenate([hole, [(2, 1.2), (-2, 1.2), (-2, -1.2), (2, -1.2)]])
    corner = count + np.arange(count) * 4 // count
    cap = []
    for i in range(count):
        j = (i + 1) % count
        cap.append([i, corner[i], j])
        if corner[i] != corner[j]:
            cap.append([j, corner[i], corner[j]])
    size = len(flat)
    walls = [(count + k, count + (k + 1) % 4) for k in range(4)]
    walls += [((k + 1) % count, k) for k in range(count)]
    faces = [face[::-1] for face in cap] + [[v + size for v in face] for face in cap]
    for a, b in walls:
        faces += [[a, b, b + size], [a, b + size, a + size]]
    return np.concatenate([np.insert(flat, 2, z, axis=1) for z in (0.0, 0.3)]), np.array(faces)


@pytest.mark.parametrize("count", [40, 60])
def test_what_variation_leaves_open_keeps_its_start(count):
    """On level 1 there is hardly a vertex inside; the system had no factor, and the run was refused."""
    sharp = {"crease_angle": 0.7, "corner_angle": 0.7}
    points, faces = plate_with_hole(count)
    for levels in (1, 2):
        result = df.fair(points, faces, levels, "minimum_variation", threads=1, **sharp)
        told = [w["code"].startswith("NOT_CONVERGED") for w in result.report["warnings"]]
        assert any(told) != result.report["converged"]
        height = result.vertices[:, 2]
        assert height.min() >= -1e-9 and height.max() <= 0.3 + 1e-9


def test_steps_on_slivers_reach_their_end_where_levels_are_large():
    """They stopped after one, 0.0046 off, with the factor that total curvature had left."""
    result = df.fair(
        *sliver_meshes.dome_of_rings(100),
        2,
        "minimum_variation",
        metric_exponent=1,
        threads=1,
    )
    points = result.vertices[np.hypot(*result.vertices[:, :2].T) < 0.98]
    assert finest(result)["converged"]
    assert np.abs(points[:, 2] - sliver_meshes.height_of_dome(points[:, :2])).max() < 0.001
