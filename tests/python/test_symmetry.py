# SPDX-License-Identifier: GPL-3.0-or-later
"""What is flat stays flat; what is mirror-symmetric stays so, however crumpled the mesh is."""

import control_meshes as meshes
import numpy as np
import pytest
import tight
from surfaces import assert_same_points, assert_same_positions, random_rotation, size_of

ENERGIES = ["total_curvature", "minimum_variation"]
FACES = ["triangles", "quads", "both"]
MODES = [
    {"metric_exponent": 1.0},
    {"metric_exponent": 0.0},
    {"chart": "tangent"},
    {"crease_angle": 1.2},
    {"interpolation": "approximate", "tolerance": 0.05},
    {"interpolation": "approximate", "tolerance": 0.05, "pad_size": 1.0},
]
EVERYWHERE = [  # of all energies
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
TO_ROUNDING = 1e-13  # of the size; steps alone leave a thousand times as much and more


def crumpled(kind: str, seed: int = 2):
    """A flat box with points moved at random, mirror-symmetric in x to the last bit."""
    points, quads = meshes.cube()
    for _ in range(2):
        points, quads = meshes.refine_quads(points, quads)
    number = {tuple(p): k for k, p in enumerate((points + 0.0).tolist())}
    image = [number[tuple(p)] for p in (points * [-1, 1, 1] + 0.0).tolist()]
    random = np.random.default_rng(seed)
    shift = random.uniform(-0.2, 0.2, points.shape)
    shift[points[:, 0] == 0, 0] = 0
    left = points[:, 0] < 0
    shift[left] = shift[image][left] * [-1, 1, 1]
    faces = []
    for face in quads[points[quads].mean(1)[:, 0] > 0].tolist():
        cut = kind == "triangles" or (kind == "both" and random.random() < 0.5)
        a, b, c, d = np.roll(face, random.integers(4)).tolist()
        half = [[a, b, c], [a, c, d]] if cut else [face]
        faces += half + [[image[v] for v in reversed(f)] for f in half]
    return (points + shift) * [1.0, 0.4, 1.0], faces


def assert_symmetric(points, axis=0, tolerance=TO_ROUNDING):
    flip = np.ones(3)
    flip[axis] = -1
    assert_same_points(points * flip, points, tolerance * size_of(points))


@pytest.mark.parametrize("levels", [1, 2])
@pytest.mark.parametrize("kind", FACES)
@pytest.mark.parametrize("energy", ENERGIES)
def test_stays_symmetric(energy, kind, levels):
    vertices, faces = crumpled(kind)
    result = tight.fair(vertices, faces, levels, energy)
    assert_symmetric(result.vertices)
    assert result.vertices[: len(vertices)].tobytes() == vertices.tobytes()


@pytest.mark.parametrize("mode", MODES, ids=str)
@pytest.mark.parametrize("kind", FACES)
@pytest.mark.parametrize("energy", ENERGIES)
def test_in_every_mode(energy, kind, mode):
    assert_symmetric(tight.fair(*crumpled(kind), 2, energy, **mode).vertices)


@pytest.mark.parametrize("kind", FACES)
@pytest.mark.parametrize("energy", ENERGIES)
def test_anywhere_and_turned(energy, kind):
    vertices, faces = crumpled(kind)
    rotation, shift = random_rotation(4), np.array([30.0, -20, 7])
    for turn in (np.eye(3), rotation):
        moved = tight.fair(vertices @ turn.T + shift, faces, 2, energy).vertices
        assert_symmetric((moved - shift) @ turn, tolerance=1e-12)


@pytest.mark.parametrize("name", ["cube", "octahedron", "icosahedron", "torus_quads"])
@pytest.mark.parametrize("energy", ["thin_plate", *ENERGIES])
def test_three_planes_at_once(energy, name):
    vertices, faces = meshes.ALL[name]()
    points = tight.fair(vertices * [1, 1.5, 0.3], faces, 3, energy).vertices
    for axis in range(3):
        assert_symmetric(points, axis, 1e-9 if energy == "thin_plate" else TO_ROUNDING)


def arch():
    """Quads with a boundary, mirror-symmetric in x and y."""
    points, quads = meshes.grid()
    points -= points.mean(0)
    points[:, 2] = np.cos(1.2 * points[:, 0]) + 0.3 * np.cos(0.8 * points[:, 1])
    return points, quads


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(
    "option", ["weights", "corner_vertices", "region", "crease_edges", "boundary_edges"]
)
def test_what_is_given_on_one_side_only_acts_on_that_side(option, side):
    """So it does where a vertex is too far off for the mesh to be symmetric."""
    vertices, faces = arch()
    at = {tuple(p): k for k, p in enumerate(vertices[:, :2].tolist())}
    rim = [at[2 * side, y] for y in (-1, 0, 1)]
    weights = np.ones(len(vertices))
    weights[at[side, 1]] = 50
    options = {
        "weights": {"interpolation": "approximate", "weights": weights},
        "corner_vertices": {"corner_vertices": [at[side, 2], at[side, -2]]},
        "region": {"region": np.flatnonzero(side * vertices[faces].mean(1)[:, 0] > -1)},
        "crease_edges": {"crease_edges": [[at[side, 0], at[side, 1]], [at[side, 0], at[side, -1]]]},
        "boundary_edges": {"boundary_edges": {"linear": [[rim[0], rim[1]], [rim[1], rim[2]]]}},
    }[option]
    settled = {"step_tolerance": 1e-9, "max_steps": 60} | options
    off = vertices.copy()
    off[at[1, 1], 2] += 1e-9
    one, other = (
        tight.fair(v, faces, 2, "total_curvature", **settled).vertices for v in (vertices, off)
    )
    assert np.abs(one - other).max() <= 1e-7
    with pytest.raises(AssertionError):
        assert_same_positions(one * [-1, 1, 1], one, 1e-4)
    if option != "weights":
        assert_symmetric(one, axis=1)


@pytest.mark.parametrize("exponent", [0.5, 1.0])
@pytest.mark.parametrize("scale", [(1, 1, 1), (1, 1, 0.1), (0.1, 1, 1)], ids=str)
@pytest.mark.parametrize("kind, seed", [("both", 1), ("both", 2), ("quads", 4)])
def test_folds_are_removed_alike_on_both_sides(kind, seed, scale, exponent):
    vertices, faces = crumpled(kind, seed)
    result = tight.fair(vertices * scale, faces, 1, metric_exponent=exponent)
    assert_symmetric(result.vertices, tolerance=1e-9)


@pytest.mark.parametrize(
    "mode",
    [*EVERYWHERE, {"pad_size": 0.5}, *TAUT, STEPS, *(STEPS | taut for taut in TAUT)],
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
    [(levels, mode) for levels in (1, 2, 3) for mode in [*EVERYWHERE, {"crease_angle": 0.8}, STEPS]]
    + [(2, STEPS | {"metric_exponent": 1.0}), (2, STEPS | {"crease_angle": 0.8})],
    ids=str,
)
def test_mirror_symmetric_stays_so(levels, mode):
    vertices, faces = meshes.creature()
    result = tight.fair(vertices, faces, levels, **mode)
    assert_same_points(result.vertices * [-1, 1, 1], result.vertices, 1e-9 * size_of(vertices))
