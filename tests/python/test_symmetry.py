# SPDX-License-Identifier: GPL-3.0-or-later
"""What is flat stays flat; what is mirror-symmetric stays so."""

import control_meshes as meshes
import numpy as np
import pytest
import tight
from mesh_files import read_mesh, weld
from shared_data import shared_files
from surfaces import assert_same_points, assert_same_positions, random_rotation, size_of

MODES = [
    {},
    {"metric_exponent": 1.0},
    {"metric_exponent": 0.0},
    {"boundary": "linear"},
    {"boundary": "free"},
    {"chart": "tangent"},
    {"interpolation": "approximate", "tolerance": 0.1},
    {"epsilon": 0.05},
]
STEPS = {"energy": "total_curvature"}
TAUT = [{"tension": 0.5, "boundary": name} for name in ("curve", "linear", "free")]


@pytest.mark.parametrize("mode", [*MODES, STEPS], ids=str)
@pytest.mark.parametrize("mesh", [meshes.grid, meshes.flat_patch], ids=["quads", "triangles"])
def test_planar_stays_planar(mesh, mode):
    vertices, faces = mesh()
    rotation, shift = random_rotation(7), np.array([1.0, 2.0, 3.0])
    result = tight.fair(vertices @ rotation.T + shift, faces, 3, **mode)
    height = (result.vertices - shift) @ rotation[:, 2]
    assert np.abs(height).max() <= 1e-9 * size_of(vertices)


@pytest.mark.parametrize(
    "mode",
    [*MODES, {"pad_size": 0.5}, *TAUT, STEPS, *(STEPS | taut for taut in TAUT)],
    ids=str,
)
@pytest.mark.parametrize("mesh", [meshes.grid, meshes.flat_patch], ids=["quads", "triangles"])
def test_a_coordinate_that_is_zero_stays_zero(mesh, mode):
    """No rotation, no rounding: x and y do not leak into z."""
    vertices, faces = mesh()
    result = tight.fair(vertices, faces, 3, **mode)
    assert not result.vertices[:, 2].any() and result.report["converged"]


@pytest.mark.parametrize(
    "levels, mode",
    [(levels, mode) for levels in (1, 2, 3) for mode in [*MODES, {"crease_angle": 0.8}, STEPS]]
    + [(2, STEPS | {"metric_exponent": 1.0}), (2, STEPS | {"crease_angle": 0.8})],
    ids=str,
)
def test_mirror_symmetric_stays_so(levels, mode):
    vertices, faces = meshes.creature()
    result = tight.fair(vertices, faces, levels, **mode)
    assert_same_points(result.vertices * [-1, 1, 1], result.vertices, 1e-9 * size_of(vertices))


@pytest.mark.parametrize("name", ["icosahedron", "octahedron", "cube"])
@pytest.mark.parametrize("mode", [{}, {"metric_exponent": 1.0}, {"pad_size": 0.5}, STEPS], ids=str)
def test_platonic_symmetry(name, mode):
    """The three coordinate planes mirror each of these."""
    vertices, faces = meshes.ALL[name]()
    result = tight.fair(vertices, faces, 3, **mode)
    for axis in range(3):
        flip = np.ones(3)
        flip[axis] = -1
        assert_same_points(result.vertices * flip, result.vertices, 1e-9 * size_of(vertices))


@pytest.mark.parametrize("path", shared_files("bad/soup_seams", ".ply"))
def test_welded_suzanne_stays_symmetric(path):
    """She is stored as a soup cut along seams, and is as symmetric afterwards as the input is."""
    if "suzanne" not in path.name:
        pytest.skip("not Suzanne")
    vertices, faces = read_mesh(path)
    points, faces = weld(vertices, faces, 5)
    size = size_of(points)
    assert_same_positions(points * [-1, 1, 1], points, 1e-9 * size)
    result = tight.fair(points, faces, 2)
    assert_same_positions(result.vertices * [-1, 1, 1], result.vertices, 1e-9 * size)
