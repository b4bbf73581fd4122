# SPDX-License-Identifier: GPL-3.0-or-later
"""Pads in place of point forces: what they do to the surface, and where they are refused."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
import pytest
import tight

MESHES = {
    "octahedron": {},
    "cube": {},
    "torus": {},
    "creature": {},
    "mixed_house": {},
    "dodecahedron": {},
    "wavy_patch": {},
    "three_handles": {},
}


def energy(result):
    return result.report["energy"]["result"]["total_curvature"] / (8 * np.pi)


@pytest.mark.parametrize("size", (0.5, 1.0))
@pytest.mark.parametrize("name", MESHES)
def test_the_surface_passes_through_every_vertex(name, size):
    vertices, faces = getattr(meshes, name)()
    result = tight.fair(vertices, faces, levels=2, pad_size=size)
    assert np.array_equal(result.vertices[: len(vertices)], vertices)
    assert result.report["converged"]
    finest = result.report["levels"][-1]
    assert finest["pad_force"] <= 1e-3


def test_pads_are_the_default():
    mesh = meshes.creature()
    plain, pads, none = df.fair(*mesh), df.fair(*mesh, pad_size=1), df.fair(*mesh, pad_size=0)
    assert np.array_equal(plain.vertices, pads.vertices)
    assert plain.report["levels"][-1]["pad_corrections"] > 0
    assert all(level["pad_corrections"] == 0 for level in none.report["levels"])


@pytest.mark.parametrize("options", ({"epsilon": 0.01}, {"method": "back_leg"}))
def test_the_papers_own_methods_have_point_forces(options):
    mesh = meshes.cube()
    pads, none = (df.fair(*mesh, pad_size=size, **options) for size in (1, 0))
    assert np.array_equal(pads.vertices, none.vertices)
    assert pads.report["pads"]["widths"] == []


@pytest.mark.parametrize(
    ("name", "most"), (("cube", 1.11), ("octahedron", 1.30), ("icosahedron", 1.02))
)
def test_inscribed_meshes_are_nearer_to_the_sphere(name, most):
    mesh = getattr(meshes, name)()
    found = [energy(tight.fair(*mesh, levels=3, pad_size=size)) for size in (0, 0.25, 0.5, 1)]
    assert found == sorted(found, reverse=True)
    assert found[-1] < most


def test_the_surface_is_a_linear_map_of_the_positions():
    vertices, faces = meshes.creature()
    rng = np.random.default_rng(2)
    first, second = (vertices + 0.1 * rng.standard_normal(vertices.shape) for _ in range(2))
    mixed = 0.3 * first - 0.5 * second + 1.2 * vertices + [3, -4, 5]
    result = tight.fair(
        vertices,
        faces,
        levels=2,
        pad_size=0.5,
        relative_residual=1e-12,
        shapes=[first, second, mixed],
    )
    a, b, c = result.shapes
    error = np.abs(0.3 * a - 0.5 * b + 1.2 * result.vertices + [3, -4, 5] - c).max()
    assert error < 1e-6 * np.ptp(vertices)


@pytest.mark.parametrize("size", (0.5, 1.0))
def test_threads_leave_no_trace(size):
    mesh = meshes.creature()
    one, two, five = (tight.fair(*mesh, levels=3, pad_size=size, threads=t) for t in (1, 2, 5))
    assert np.array_equal(one.vertices, two.vertices)
    assert np.array_equal(one.vertices, five.vertices)


def test_a_plane_stays_one():
    vertices, faces = meshes.flat_patch()
    result = tight.fair(vertices, faces, levels=3, pad_size=0.5)
    assert np.abs(result.vertices[:, 2]).max() < 1e-9
    assert result.report["converged"]


def test_a_symmetric_mesh_stays_symmetric():
    vertices, faces = meshes.cube()
    points = tight.fair(vertices, faces, levels=3, pad_size=0.5, relative_residual=1e-11).vertices
    for axis in range(3):
        image = points.copy()
        image[:, axis] *= -1
        nearest = np.linalg.norm(points[:, None] - image[None], axis=2).min(1)
        assert nearest.max() < 1e-7


@pytest.mark.parametrize("joint", ("position", "tangent", "curvature"))
def test_regions_leave_the_rest_alone(joint):
    columns = 9
    vertices, faces = meshes.wavy_patch(columns, columns)
    region = [
        f
        for f, face in enumerate(faces)
        if np.abs(vertices[face].mean(0)[:2] - vertices.mean(0)[:2]).max()
        < 0.3 * np.ptp(vertices[:, 0])
    ]
    needles, pads = (
        tight.fair(vertices, faces, levels=2, region=region, joint=joint, pad_size=size)
        for size in (0, 0.5)
    )
    assert pads.report["converged"]
    _, quads = pads.faces
    outside = np.ones(len(faces), bool)
    outside[region] = False
    kept = np.unique(quads[outside[pads.quad_polygon]])
    assert np.array_equal(needles.vertices[kept], pads.vertices[kept])
    assert not np.array_equal(needles.vertices, pads.vertices)


def test_curves_depend_on_their_own_vertices_alone():
    vertices, faces = meshes.wavy_patch(6, 5)
    for boundary in ("curve", "linear"):
        needles, pads = (
            tight.fair(vertices, faces, levels=2, boundary=boundary, pad_size=size)
            for size in (0, 1)
        )
        _, quads = pads.faces
        edges = np.sort(quads[:, [0, 1, 1, 2, 2, 3, 3, 0]].reshape(-1, 2), 1)
        unique, uses = np.unique(edges, axis=0, return_counts=True)
        rim = np.unique(unique[uses == 1])
        assert np.array_equal(needles.vertices[rim], pads.vertices[rim])
        assert pads.report["converged"]


def test_a_solver_follows_moved_vertices():
    vertices, faces = meshes.creature()
    solver = tight.Solver(vertices, faces, levels=3, pad_size=0.5)
    assert np.array_equal(
        solver.solve().vertices, tight.fair(vertices, faces, levels=3, pad_size=0.5).vertices
    )
    moved = vertices.copy()
    for _ in range(4):
        moved[10] += [0.02, 0.01, 0]
        result = solver.solve(moved)
        alone = tight.fair(vertices, faces, levels=3, pad_size=0.5, shapes=moved[None]).shapes[0]
        assert result.report["warm"] and result.report["converged"]
        assert np.array_equal(result.vertices[: len(moved)], moved)
        assert np.abs(result.vertices - alone).max() < 5e-5 * np.ptp(vertices)


def ball_and_its_images():
    """A round ball, and of each vertex the one on the other side of x = 0."""
    vertices, faces = meshes.rough_ball(roughness=0)
    distance = np.linalg.norm(vertices[:, None] * [-1, 1, 1] - vertices[None], axis=2)
    assert distance.min(1).max() < 1e-12
    return vertices, faces, distance.argmin(1)


@pytest.mark.parametrize("seed", (1, 3, 4))
@pytest.mark.parametrize("size", (0.5, 1.0))
def test_pads_give_way_where_a_mesh_is_crumpled(seed, size):
    mesh = meshes.rough_ball(seed, 1)
    needles, pads = (tight.fair(*mesh, levels=2, pad_size=s) for s in (0, size))
    assert energy(pads) < 1.1 * energy(needles)
    assert pads.report["converged"]
    found = pads.report["pads"]
    widths = np.array(found["widths"])
    assert len(widths) == len(mesh[0])
    assert set(widths) <= {0, size, size / 2, size / 4, size / 8}
    assert found["narrower"] == ((widths > 0) & (widths < size)).sum() > 0
    assert found["gone"] == (widths == 0).sum()
    assert np.array_equal(pads.vertices[: len(mesh[0])], mesh[0])


@pytest.mark.parametrize("name", ("creature", "icosahedron", "torus", "three_handles"))
def test_smooth_meshes_keep_all_widths(name):
    report = tight.fair(*getattr(meshes, name)(), levels=3, pad_size=0.5).report
    assert set(report["pads"]["widths"]) == {0.5}
    assert report["pads"]["narrower"] == report["pads"]["gone"] == 0


def test_without_pads_there_are_no_widths():
    report = tight.fair(*meshes.cube(), levels=1).report
    assert report["pads"] == {"narrower": 0, "gone": 0, "widths": []}


def test_widths_depend_neither_on_threads_nor_on_the_side():
    vertices, faces, image = ball_and_its_images()
    rough, _ = meshes.rough_ball(roughness=1)
    right = vertices[:, 0] > 1e-12
    vertices[right] = rough[right]
    vertices[image[right]] = rough[right] * [-1, 1, 1]
    one, two = (tight.fair(vertices, faces, levels=3, pad_size=0.5, threads=t) for t in (1, 2))
    assert one.report["pads"] == two.report["pads"]
    assert np.array_equal(one.vertices, two.vertices)
    widths = np.array(one.report["pads"]["widths"])
    assert len(set(widths)) > 1
    assert np.array_equal(widths, widths[image])


def test_widths_stay_while_vertices_move():
    vertices, faces = meshes.rough_ball(roughness=1)
    solver = tight.Solver(vertices, faces, levels=2, pad_size=0.5)
    first = solver.solve().report["pads"]
    assert first["narrower"] > 0
    round_ball, _ = meshes.rough_ball(roughness=0)
    assert solver.solve(round_ball).report["pads"] == first
    solver.rebase(round_ball)
    assert set(solver.solve(round_ball).report["pads"]["widths"]) == {0.5}


@pytest.mark.parametrize("size", (-0.1, 1.5))
def test_sizes_beyond_the_faces_are_refused(size):
    with pytest.raises(df.FairingError, match="pad_size"):
        tight.fair(*meshes.cube(), pad_size=size)


def test_a_run_on_pads_can_be_cancelled():
    with pytest.raises(df.FairingError) as caught:
        tight.fair(*meshes.creature(), levels=6, pad_size=0.5, progress=lambda *_: False)
    assert caught.value.code == "CANCELLED"


@pytest.mark.parametrize("levels", (4, 5))
@pytest.mark.parametrize("name", ("icosahedron", "rough_ball"))
def test_as_little_is_left_at_the_vertices_on_every_level(name, levels):
    """On fine levels more was left, since the polyhedron's own forces grow."""
    mesh = getattr(meshes, name)()
    pads = df.fair(*mesh, levels)
    assert pads.report["levels"][-1]["pad_force"] <= 2e-3
    exact = df.fair(*mesh, levels, relative_residual=1e-8)
    off = np.abs(pads.vertices - exact.vertices).max() / np.ptp(exact.vertices, axis=0).max()
    assert off <= 4e-5


def test_a_fine_level_takes_few_iterations():
    """Measured: 7 where point forces take 5; 9 from loads that had only been prolongated."""
    level = df.fair(*meshes.rough_ball(roughness=0.25), 4).report["levels"][-1]
    assert level["iterations"] <= 8 and level["pad_corrections"] <= 2
    assert not level["blocks"]


def test_a_drag_takes_hardly_any_iterations():
    """The difference is solved for on coarse levels first, and a surface that has been foreseen is
    not solved for again: measured, 0 to 4 a move."""
    vertices, faces = meshes.torus(10, 8)
    solver = df.Solver(vertices, faces, levels=4)
    solver.solve(vertices)
    moved, finest = vertices.copy(), []
    for move in range(8):
        moved[0] += [0.01, 0.02, 0.02]
        levels = solver.solve(moved).report["levels"]
        finest.append(levels[-1]["iterations"])
        if move == 0:
            assert sum(level["iterations"] for level in levels[:-1]) > 0
    assert sorted(finest)[4] <= 2 and max(finest[1:]) <= 4
    exact = df.Solver(vertices, faces, levels=4, relative_residual=1e-8)
    off = np.abs(solver.solve(moved).vertices - exact.solve(moved).vertices).max()
    assert off <= 5e-5 * np.ptp(vertices, axis=0).max()


def test_few_pads_give_way_on_a_rough_mesh():
    """One that is gone bends the stars beside it, which must not take theirs away in turn."""
    vertices, faces = meshes.torus(100, 70)
    edge = np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean()
    noise = np.random.default_rng(1).uniform(-1, 1, vertices.shape)
    report = df.fair(vertices + 0.12 * edge * noise, faces, levels=2).report
    assert report["converged"]
    assert report["pads"]["gone"] < 20 and report["pads"]["narrower"] < 300
    assert report["iterations"][-1] < 70
