# SPDX-License-Identifier: GPL-3.0-or-later
"""Through the limit positions: where they are, and that the surface passes exactly through them."""

import discrete_fairing as df
import numpy as np
import pytest
import thin_walls
from catmull_clark import subdivide
from control_meshes import HOUSE, cube, grid, octahedron, refine_quads
from discrete_fairing import _native

RANDOM = np.random.default_rng(7)
CUBE = cube()


def limits(vertices, faces, sharp_edges=(), sharp_vertices=(), **more):
    sharp, corners = dict(sharp_edges), dict(sharp_vertices)
    given = dict(more)
    if sharp:
        given["edge_sharpness"] = (list(sharp), list(sharp.values()))
    if corners:
        given["vertex_sharpness"] = [corners.get(v, 0.0) for v in range(len(vertices))]
    found = df.fair(vertices, faces, 0, interpolation="limit", **given)
    return found.vertices[: len(vertices)]


@pytest.mark.parametrize(
    "sharp",
    [{}, {(4, 5): 1.0}, {(4, 5): 2.6, (5, 6): 2.6}, {(4, 5): 0.3, (5, 6): 1.7, (5, 8): 3.2}, {(4, 8): np.inf, (8, 9): 0.5}],
)  # fmt: skip
@pytest.mark.parametrize("corners", [{}, {5: 1.4, 6: 3.0}])
def test_a_limit_is_that_of_the_subdivided_mesh(sharp, corners):
    vertices, faces = HOUSE
    sharp = {edge: min(s, 1e9) for edge, s in sharp.items()}
    state = (vertices, faces, sharp, corners)
    here = limits(*state)
    for _ in range(2):
        state = subdivide(*state)
        # borders have a rule of their own, and are not given
        own = {e: s for e, s in state[2].items() if np.isfinite(s)}
        np.testing.assert_allclose(limits(*state[:2], own, state[3])[:10], here, rtol=0, atol=1e-12)


def test_always_sharp_edges_are_creases_and_two_of_them_a_curve():
    vertices, faces = HOUSE
    pairs = [[4, 8], [8, 5]]
    creased = limits(vertices, faces, crease_edges=pairs)
    np.testing.assert_allclose(
        creased[8], (vertices[4] + 4 * vertices[8] + vertices[5]) / 6, atol=1e-15
    )
    np.testing.assert_array_equal(creased, limits(vertices, faces, {(4, 8): 10, (5, 8): 99.0}))
    soft = limits(vertices, faces, {(4, 8): 0.5, (5, 8): 0.5}, crease_edges=pairs)
    assert np.abs(soft[8] - creased[8]).max() > 0.01  # the sharpness that is given counts


def test_corners_and_straight_borders_stay_to_the_last_bit():
    vertices, faces = grid(4, 3)
    vertices = vertices + 0.1 * RANDOM.standard_normal(vertices.shape)
    corner = limits(vertices, faces, corner_vertices=[0, 6])
    np.testing.assert_array_equal(corner[[0, 6]], vertices[[0, 6]])
    assert np.abs(corner[1] - vertices[1]).max() > 0.001
    counts = np.bincount(np.ravel(faces), minlength=len(vertices))
    border = counts < 4
    straight = limits(vertices, faces, boundary="linear")
    np.testing.assert_array_equal(straight[border], vertices[border])
    assert np.abs(straight[~border] - vertices[~border]).max() > 0.001


def test_the_surface_passes_exactly_through_them():
    vertices, faces = HOUSE
    here = limits(vertices, faces)
    for energy in ("thin_plate", "total_curvature"):
        fine = df.fair(vertices, faces, 2, energy, interpolation="limit")
        np.testing.assert_array_equal(fine.vertices[:10], here)
        moved = np.linalg.norm(here - vertices, axis=1).max()
        assert fine.report["largest_deviation"] == pytest.approx(moved, rel=1e-12)


@pytest.mark.parametrize(
    ("energy", "more"),
    [("thin_plate", 1.006), ("total_curvature", 1.02), ("minimum_variation", 1.05)],
)
@pytest.mark.parametrize("name", thin_walls.MODELS)
def test_rims_turn_as_they_do_when_subdivided(name, energy, more):
    """Waves add to the turn of a rim: on a free rim of most meshes by a half and more."""
    model = thin_walls.MODELS[name]()
    subdivided = thin_walls.of_subdivision(model, 2)
    found = thin_walls.of_surface(model, 2, energy=energy, interpolation="limit")
    assert found < more * subdivided


@pytest.mark.parametrize("name", ["cup", "sheet"])
def test_minimum_variation_settles_on_thin_walls(name):
    """Where its cycles do not know the penalty, its steps end early, and the sheet's rim waves."""
    model = thin_walls.MODELS[name]()
    options = {"energy": "minimum_variation", "interpolation": "limit"}
    assert df.fair(*model[:2], 3, **options).report["converged"]
    found = thin_walls.of_surface(model, 3, **options)
    assert found < 1.02 * thin_walls.of_subdivision(model, 3)


def test_loads_on_pads_settle_on_thin_walls():
    """Under the penalty a residual moves only the points near it: loads corrected as if it moved whole faces
    did not settle in 32 corrections."""
    vertices, faces = thin_walls.MODELS["wing"]()[:2]
    report = df.fair(vertices, faces, 3, interpolation="limit").report
    assert report["converged"]
    assert max(level["pad_corrections"] for level in report["levels"]) < 16


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature", "minimum_variation"])
def test_the_surface_is_flat_where_the_subdivided_one_is(energy):
    """Amid flats the surface of this slab turns by 1 degree and more where it follows nothing."""
    vertices, faces = refine_quads(*refine_quads(*CUBE))
    vertices = vertices * [1, 1, 0.2]
    amid = (np.abs(vertices[faces][..., :2]) < 0.9 * vertices[:, 0].max()).all(axis=(1, 2))

    def tilt(limit):
        found = df.fair(vertices, faces, 2, energy, interpolation="limit", limit=limit)
        corners = found.vertices[found.faces[1][amid[found.quad_polygon]]]
        normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        tangents = np.linalg.norm(normals[:, :2], axis=1) / np.abs(normals[:, 2])
        return np.degrees(np.arctan(tangents.max()))

    assert tilt(1.0) < 0.1
    assert tilt(0.0) > 1.0


@pytest.mark.parametrize("energy", ["thin_plate", "total_curvature", "minimum_variation"])
def test_flats_beside_tight_rims_do_not_swell(energy):
    """The limit surface lies in the slab; a surface that follows it amid flats only, not in the faces between
    there and loop cuts, leaves it by .0014, .016 and .016."""
    vertices, faces = refine_quads(*refine_quads(*CUBE))
    share = np.abs(vertices) / vertices.max()
    slab = np.sign(vertices) * np.where(share == 0.5, 0.9, share) * [1, 1, 0.2]
    found = df.fair(slab, faces, 2, energy, interpolation="limit").vertices
    outside = (np.abs(found) - [1, 1, 0.2]).max()
    assert outside < (1e-4 if energy == "thin_plate" else 5e-3)


@pytest.mark.parametrize("mesh", [CUBE, HOUSE, octahedron()], ids=["cube", "house", "triangles"])
def test_the_surface_comes_near_to_the_subdivided_one(mesh):
    """On quads, triangles and pentagons: the nearer the more it follows; at limits always."""
    state = mesh
    for _ in range(4):
        state = subdivide(*state)
    there = limits(state[0], state[1])

    def mean_distance(limit):
        found = df.fair(*mesh, 2, interpolation="limit", limit=limit).vertices
        np.testing.assert_array_equal(found[: len(mesh[0])], limits(*mesh))
        return np.mean([np.linalg.norm(there - p, axis=1).min() for p in found])

    off = [mean_distance(limit) for limit in (0.0, 0.6, 1.0)]
    assert off[0] > off[1] > off[2]


def snout(sides, thickness):
    """A flat wedge whose tip is far ahead of a fine rim: its front is of long, thin triangles."""
    turn = 2 * np.pi * np.arange(sides) / sides
    rim = np.stack([0 * turn, np.cos(turn), thickness * np.sin(turn)], axis=1)
    behind = np.stack([0 * turn - 1, 1.2 * np.cos(turn), 1.2 * thickness * np.sin(turn)], axis=1)
    vertices = np.concatenate([rim, behind, [[10, 0, 0], [-1.5, 0, 0]]])
    tip, end = 2 * sides, 2 * sides + 1
    faces = []
    for k in range(sides):
        j = (k + 1) % sides
        faces += [
            [k, j, tip],
            [k, k + sides, j],
            [j, k + sides, j + sides],
            [j + sides, k + sides, end],
        ]
    return vertices, faces


@pytest.mark.parametrize("sides", [12, 16])
@pytest.mark.parametrize("thickness", [0.1, 0.2])
def test_long_thin_faces_do_not_swing_through_each_other(sides, thickness):
    found = df.fair(*snout(sides, thickness), 3, interpolation="limit")
    triangles = np.ascontiguousarray(found.triangles, np.int32)
    assert not len(_native._crossings(found.vertices, triangles, 0, _native.Monitor(), None))


def test_outside_a_region_and_on_its_rim_nothing_moves():
    vertices, faces = grid(7, 7)
    vertices = vertices + 0.1 * RANDOM.standard_normal(vertices.shape)
    faces = np.asarray(faces)
    chosen = np.flatnonzero(
        (np.abs(vertices[faces].mean(axis=1)[:, :2] - vertices[:, :2].mean(axis=0)) < 2).all(axis=1)
    )
    result = df.fair(vertices, faces, 1, interpolation="limit", region=chosen)
    inner = np.bincount(faces[chosen].ravel(), minlength=len(vertices)) == 4
    assert 0 < inner.sum() < len(vertices)
    np.testing.assert_array_equal(result.vertices[: len(vertices)][~inner], vertices[~inner])
    np.testing.assert_array_equal(
        result.vertices[: len(vertices)][inner], limits(vertices, faces)[inner]
    )
