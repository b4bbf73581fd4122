# SPDX-License-Identifier: GPL-3.0-or-later
"""strain(): against its direct definition, and on surfaces with a planted error."""

import control_meshes
import discrete_fairing as df
import numpy as np
import pytest


def bump(across=9, along=7, seed=1, noise=0.0):
    """Quads on a smooth bump, 1 long; (vertices, faces, inner vertices)."""
    x, y = np.meshgrid(np.linspace(0, 1, across), np.linspace(0, 0.75, along), indexing="ij")
    z = 0.2 * np.exp(-12 * ((x - 0.5) ** 2 + (y - 0.375) ** 2))
    points = np.stack([x, y, z], -1).reshape(-1, 3)
    points[:, 2] += noise * np.random.default_rng(seed).normal(size=len(points))
    i, j = np.meshgrid(np.arange(across - 1), np.arange(along - 1), indexing="ij")
    a = (i * along + j).ravel()
    inner = np.arange(across * along).reshape(across, along)[1:-1, 1:-1].ravel()
    return points, np.stack([a, a + along, a + along + 1, a + 1], -1), inner


def rough(mesh, size, seed):
    points, faces = mesh
    return points + size * np.random.default_rng(seed).normal(size=points.shape), faces


def let_go(points, faces, vertex):
    """The way by which a vertex moves where all but it are held."""
    weights = np.full(len(points), np.inf)
    weights[vertex] = 0.0
    result = df.fair(
        points,
        faces,
        levels=2,
        interpolation="approximate",
        weights=weights,
        relative_residual=1e-6,
    )
    return result.vertices[vertex] - points[vertex]


def on_border(faces):
    """Ids of border vertices of quads or triangles."""
    edges, number = control_meshes.edges_of(np.asarray(faces))
    return np.unique(edges[np.bincount(number.ravel()) == 1])


MESHES = {
    "bump": lambda: bump(seed=1, noise=0.003)[:2],
    "torus": lambda: rough(control_meshes.torus(12, 8), 0.02, 2),
    "torus of triangles": lambda: control_meshes.cut_quads(
        rough(control_meshes.torus(12, 8), 0.02, 3)
    ),
    "random hull": lambda: control_meshes.random_hull(40),
    "cube": lambda: rough(control_meshes.cube(), 0.05, 4),
    "octahedron": lambda: rough(control_meshes.octahedron(), 0.05, 5),
}


@pytest.mark.parametrize("name", MESHES)
def test_strain_is_the_way_of_a_vertex_let_go(name):
    points, faces = MESHES[name]()
    found = df.strain(points, faces, relative_residual=1e-6)
    inside = np.setdiff1d(np.arange(len(points)), on_border(faces))
    held = inside[~np.isnan(found.lengths[inside])]
    ids = np.random.default_rng(6).permutation(held)[:8]
    largest = np.linalg.norm(found.ways[held], axis=1).max()
    for vertex in ids:
        way = let_go(points, faces, vertex)
        error = np.linalg.norm(found.ways[vertex] - way)
        assert error <= 0.05 * max(np.linalg.norm(way), 0.1 * largest), (vertex, error, way)


SHAPES = {
    "bump": lambda x, y: 0.1 * np.exp(-6 * (x**2 + y**2)),
    "saddle": lambda x, y: 0.4 * (x**2 - y**2),
    "wave": lambda x, y: 0.05 * np.sin(4 * x + 2 * y + 3),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_planted_error_of_six_deviations_is_the_worst(shape):
    points, faces, inner = bump()
    points[:, 2] = SHAPES[shape](points[:, 0] - 0.5, points[:, 1] - 0.375)
    noise, found = 0.0007, []
    for seed in range(20):
        random = np.random.default_rng(seed)
        measured = points.copy()
        measured[:, 2] += noise * random.normal(size=len(points))
        vertex = random.choice(inner)
        measured[vertex, 2] += 6 * noise
        strain = df.strain(measured, faces)
        # it stands out, and would spring back
        worst = inner[np.argmax(np.abs(strain.lengths[inner]))]
        found.append(worst == vertex and strain.lengths[vertex] < 0)
    assert sum(found) >= 18


def test_vertices_on_the_border_have_the_strain_of_its_curve():
    points, faces, inner = bump()
    points[:, 2] = 0.4 * (points[:, 0] ** 3 - points[:, 1] ** 2)  # no load on straight borders
    wrong = 2 * 7  # the third vertex of nine on a border
    points[wrong, 2] += 0.01
    found = df.strain(points, faces)
    held = ~np.isnan(found.lengths)
    sides = [range(2 * 7, 7 * 7, 7), range(2 * 7 + 6, 7 * 7, 7), range(2, 5), range(58, 61)]
    assert set(np.flatnonzero(held)) == set(inner).union(*sides)
    np.testing.assert_allclose(found.ways[wrong], (0, 0, -0.01), atol=5e-4)
    assert len(found.worst(100)) == held.sum()


def test_it_is_a_length_and_turns_with_the_mesh():
    points, faces = MESHES["torus"]()
    turn = np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    found = df.strain(points, faces, relative_residual=1e-8)
    moved = df.strain(40 * points @ turn.T + 3, faces, relative_residual=1e-8)
    # loads are read to 1e-3
    near = 5e-3 * np.abs(found.lengths).max()
    np.testing.assert_allclose(moved.lengths / 40, found.lengths, atol=near)
    np.testing.assert_allclose(moved.ways / 40, found.ways @ turn.T, atol=near)


def test_any_threads_give_the_same_bits():
    points, faces = MESHES["torus"]()
    one, two = (df.strain(points, faces, threads=n) for n in (1, 2))
    assert np.array_equal(one.lengths, two.lengths) and np.array_equal(one.ways, two.ways)


def test_half_a_torus_has_the_strain_of_the_whole():
    points, faces = control_meshes.torus(12, 8)
    whole = df.strain(points, faces)
    in_half = (points[faces][..., 0].min(1) > -1e-9).nonzero()[0]
    points = points.copy()
    points[np.abs(points[:, 0]) < 1e-9, 0] = 0
    used, ids = np.unique(faces[in_half], return_inverse=True)
    half = df.strain(points[used], ids.reshape(-1, 4), symmetry_plane="x")
    np.testing.assert_allclose(
        half.lengths, whole.lengths[used], atol=0.02 * np.abs(whole.lengths).max()
    )


@pytest.mark.parametrize(
    "settings, words",
    [
        ({"energy": "minimum_variation"}, "no pads"),
        ({"energy": "total_curvature"}, "thin plate"),
        ({"interpolation": "approximate", "tolerance": 0.1}, "exact"),
        ({"pad_size": 0.0}, "pads"),
    ],
)
def test_what_has_no_loads_says_why(settings, words):
    with pytest.raises(df.FairingError, match=words) as caught:
        df.strain(*control_meshes.cube(), **settings)
    assert caught.value.code == "BAD_OPTION"


def test_it_can_be_cancelled():
    with pytest.raises(df.FairingError) as caught:
        df.strain(*control_meshes.torus(60, 40), progress=lambda *_: False)
    assert caught.value.code == "CANCELLED"


def test_a_result_has_its_strain_where_it_is_asked_for():
    points, faces = MESHES["torus"]()
    alone = df.strain(points, faces)
    for energy in ("thin_plate", "total_curvature"):
        result = df.fair(points, faces, 2, energy, strain=True)
        np.testing.assert_array_equal(result.strain, alone.lengths)
        worst = alone.worst(1)[0]
        assert result.report["strain"] == {
            "largest": alone.lengths[worst],
            "vertex": worst,
            "noise": alone.noise,
        }
    assert df.fair(points, faces, 2).strain is None
    with pytest.raises(df.FairingError, match="no pads"):
        df.fair(points, faces, 2, "minimum_variation", strain=True)


def test_scatter_is_read_off_strain():
    points, faces, inner = bump(25, 19)
    points[:, 2] = 0
    points[inner, 2] = 0.001 * np.random.default_rng(8).normal(size=len(inner))
    assert abs(df.strain(points, faces).noise / 0.001 - 1) < 0.15
