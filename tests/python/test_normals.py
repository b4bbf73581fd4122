# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals that the caller fixes at control vertices."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
from half_hulls import hull, whole
from surfaces import boundary_vertices, output_faces, size_of

LARGEST = 0.05  # degrees that are left by default
SIDE = 6  # quads of the plate
MIDDLE = (SIDE + 1) * (SIDE // 2) + SIDE // 2


def none(points) -> np.ndarray:
    return np.full((len(points), 3), np.nan)


def tilted(points, vertex, direction) -> np.ndarray:
    normals = none(points)
    normals[vertex] = direction
    return normals


def angle(a, b) -> float:
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)))


def vertex_normal(result, vertex) -> np.ndarray:
    """From the faces around, with the weights of Max (1999): exact on spheres."""
    points, normal = result.vertices, np.zeros(3)
    for face in output_faces(result):
        if vertex in face:
            at = face.index(vertex)
            a = points[face[at - len(face) + 1]] - points[vertex]
            b = points[face[at - 1]] - points[vertex]
            normal += np.cross(a, b) / ((a @ a) * (b @ b))
    return normal / np.linalg.norm(normal)


@pytest.fixture(scope="module")
def plate():
    return meshes.grid(SIDE, SIDE)


@pytest.mark.parametrize("pad_size,lift", [(1.0, 0.217), (0.0, 0.233)])
@pytest.mark.parametrize("levels", [3, 4, 5])
def test_a_slope_of_one_lifts_a_plate_as_high_on_every_level(plate, levels, pad_size, lift):
    """Measured: 0.219, 0.215, 0.214 on pads, 0.239, 0.231, 0.228 on points: ever less."""
    points, faces = plate
    options = {"pad_size": pad_size, "boundary": "linear"}
    flat = df.fair(points, faces, levels, **options).vertices
    result = df.fair(points, faces, levels, normals=tilted(points, MIDDLE, [-1, 0, 1]), **options)
    half = np.abs(flat - points[MIDDLE] - [0.5, 0, 0]).max(1).argmin()
    assert np.abs(flat[:, 2]).max() < 1e-12
    moved = result.vertices[half] - flat[half]
    along = np.array([-1, 0, 1]) / 2**0.5
    assert np.linalg.norm(moved - moved @ along * along) < 1e-6, "along the normal"
    assert moved @ along * 2**0.5 == pytest.approx(lift, abs=0.007)
    assert result.report["normals"]["fixed"] == 1
    assert result.report["normals"]["largest_angle"] <= LARGEST
    assert result.report["converged"] and not result.report["warnings"]


def test_the_surface_has_the_normal_that_was_asked_for(plate):
    points, faces = plate
    direction = np.array([0.2, -0.3, 1.0])
    free = df.fair(points, faces, 5)
    result = df.fair(points, faces, 5, normals=tilted(points, MIDDLE, 7 * direction))
    assert angle(vertex_normal(free, MIDDLE), direction) > 19
    assert angle(vertex_normal(result, MIDDLE), direction) < 1
    assert np.array_equal(result.vertices[: len(points)], points)
    assert result.report["levels"][-1]["normal_angle"] <= LARGEST


MESHES = {
    "icosahedron": meshes.icosahedron,
    "creature": meshes.creature,
    "torus_quads": meshes.torus,
    "cube": meshes.cube,
    "wavy_patch": meshes.wavy_patch,
    "house": meshes.mixed_house,
    "dodecahedron": meshes.dodecahedron,
}


@pytest.mark.parametrize("levels", [1, 2, 3, 4])
@pytest.mark.parametrize("name", list(MESHES))
def test_single_normals_on_all_kinds_of_meshes(name, levels):
    points, faces = MESHES[name]()
    free = df.fair(points, faces, levels)
    inside = np.setdiff1d(np.arange(len(points)), boundary_vertices(output_faces(free)))
    vertex = inside[len(inside) // 2]
    direction = vertex_normal(free, vertex) + [0.1, 0.15, -0.1]
    result = df.fair(points, faces, levels, normals=tilted(points, vertex, direction))
    assert result.report["normals"]["fixed"] == 1
    assert result.report["normals"]["largest_angle"] <= LARGEST
    assert result.report["converged"]
    assert np.array_equal(result.vertices[: len(points)], points)
    moved = np.linalg.norm(result.vertices - free.vertices, axis=1)
    assert 1e-4 < moved.max() < 0.5 * size_of(points)


@pytest.mark.parametrize("nothing", [np.nan, 0.0])
def test_rows_of_nothing_leave_the_surface_to_itself(nothing):
    points, faces = meshes.creature()
    free = df.fair(points, faces, 2, "total_curvature")
    given = df.fair(points, faces, 2, "total_curvature", normals=np.full((len(points), 3), nothing))
    assert np.array_equal(free.vertices, given.vertices)
    assert given.report["normals"] == {"fixed": 0, "largest_angle": 0.0}


def test_half_a_mesh_has_the_normals_of_the_whole():
    points, faces = hull()
    everything, all_faces = whole(points, faces)
    vertex = 14
    normals = tilted(
        points, vertex, vertex_normal(df.fair(points, faces, 0), vertex) + [0.2, 0.1, 0.1]
    )
    both = none(everything)
    both[: len(points)] = normals
    image = np.flatnonzero(np.abs(everything - points[vertex] * [1, -1, 1]).max(1) < 1e-12)
    both[image] = normals[vertex] * [1, -1, 1]
    half = df.fair(points, faces, 2, normals=normals, symmetry_plane="y", relative_residual=1e-8)
    full = df.fair(everything, all_faces, 2, normals=both, relative_residual=1e-8)
    found = np.linalg.norm(half.vertices[:, None] - full.vertices[None], axis=2).min(1)
    assert found.max() < 1e-6 and half.report["normals"]["fixed"] == 2


@pytest.mark.parametrize(
    "options",
    [
        {"pad_size": 0.0},
        {"pad_size": 0.5},
        {"tension": 0.5},
        {"metric_exponent": 1.0},
        {"chart": "tangent"},
        {"epsilon": 0.01},
        {"interpolation": "approximate", "tolerance": 0.02},
        {"interpolation": "approximate", "tolerance": 1e-3},
        {"interpolation": "approximate", "tolerance": 0.02, "pad_size": 0.0},
        {"interpolation": "approximate", "weights": np.full(98, 30.0)},
        {"boundary": "free"},
    ],
    ids=str,
)
def test_together_with_other_settings(options):
    points, faces = meshes.creature()
    free = df.fair(points, faces, 3, **options)
    chosen = [10, 40, 41, 70]
    normals = none(points)
    for vertex in chosen:
        normals[vertex] = vertex_normal(free, vertex) + [0.1, -0.1, 0.15]
    result = df.fair(points, faces, 3, normals=normals, **options)
    assert result.report["normals"]["largest_angle"] <= LARGEST
    assert result.report["converged"] and not result.report["warnings"]
    assert result.report["largest_deviation"] <= options.get("tolerance", 1.0)
    assert np.abs(result.vertices - free.vertices).max() > 1e-3


def test_a_region_has_only_the_normals_inside():
    points, faces = meshes.grid(8, 8)
    centres = points[faces].mean(1)[:, :2]
    region = np.flatnonzero(np.abs(centres - 4).max(1) < 3)
    normals = none(points)
    inside, outside = 9 * 4 + 4, 9 * 4
    normals[inside], normals[outside] = [0.3, 0, 1], [0.3, 0, 1]
    result = df.fair(points, faces, 3, region=region, normals=normals)
    assert result.report["normals"]["fixed"] == 1 and not result.report["warnings"]
    assert result.report["normals"]["largest_angle"] <= LARGEST


def test_vertices_on_creases_are_left_and_named(plate):
    points, faces = plate
    normals = tilted(points, [0, MIDDLE, MIDDLE + 8], [0.2, 0, 1])
    result = df.fair(points, faces, 2, normals=normals, crease_edges=[[MIDDLE, MIDDLE + 1]])
    (warning,) = result.report["warnings"]
    assert warning["code"] == "NORMAL_NOT_FIXED" and warning["elements"] == [0, MIDDLE]
    assert warning["kind"] == "vertex" and result.report["normals"]["fixed"] == 1


def test_normals_against_the_surface_are_refused(plate):
    points, faces = plate
    for direction in ([1, 0, 0.05], [0, 0, -1], [1, 0, 0]):
        with pytest.raises(df.FairingError, match="80 degrees") as caught:
            df.fair(points, faces, 2, normals=tilted(points, MIDDLE, direction))
        assert (caught.value.code, caught.value.elements) == ("BAD_OPTION", [MIDDLE])
    steep = df.fair(points, faces, 2, normals=tilted(points, MIDDLE, [4, 0, 1]))
    assert np.isfinite(steep.vertices).all() and steep.report["normals"]["largest_angle"] <= LARGEST


def test_a_solver_follows_moved_vertices():
    points, faces = meshes.creature()
    normals = none(points)
    for vertex in (10, 40):
        normals[vertex] = vertex_normal(df.fair(points, faces, 3), vertex) + [0.1, 0.2, 0]
    solver = df.Solver(points, faces, 3, normals=normals)
    first = solver.solve()
    assert np.array_equal(first.vertices, df.fair(points, faces, 3, normals=normals).vertices)
    moved = points.copy()
    for _ in range(4):
        moved[10] += [0.02, 0.01, 0]
        result = solver.solve(moved)
        alone = df.fair(points, faces, 3, normals=normals, shapes=[moved]).shapes[0]
        assert result.report["warm"] and result.report["converged"]
        assert result.report["normals"]["largest_angle"] <= LARGEST
        assert np.abs(result.vertices - alone).max() < 1e-4 * size_of(points)
    solver.rebase(points)
    assert np.array_equal(solver.solve().vertices, first.vertices)
