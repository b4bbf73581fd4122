# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions: the outside stays on the control polygons to the last bit, and the joint keeps its promise."""

import control_meshes as meshes
import numpy as np
import pytest
from surfaces import as_lists
from tight import fair

JOINTS = ("position", "tangent", "curvature")


def ramp(columns=6, gap=2, triangles=False):
    """The planes z = 0 and z = 1 with a slope between: (vertices, faces), the slope's faces, its ends in x."""
    points, quads = meshes.grid(columns, 4)
    low = (columns - gap) // 2
    high = low + gap
    points[:, 2] = np.clip((points[:, 0] - low) / gap, 0, 1)
    middle = points[quads].mean(1)[:, 0]
    region = np.nonzero((middle > low) & (middle < high))[0]
    if not triangles:
        return (points, quads), region, (low, high)
    return (
        meshes.cut_quads((points, quads)),
        np.stack([2 * region, 2 * region + 1], -1).reshape(-1),
        (low, high),
    )


def profile(result, low, level):
    """The line y = 2 of a ramp of quads, from the joint on, at lattice steps."""
    line = result.vertices[np.abs(result.vertices[:, 1] - 2) < 1e-9]
    line = line[np.argsort(line[:, 0])]
    return line[np.argmin(np.abs(line[:, 0] - low)) :]


def lattice_points(corners, n):
    """All points of the closed lattice of a face, as the sums that the core does."""
    c = np.asarray(corners, float)
    if len(c) == 3:
        weights = [(n - i - j, i, j) for j in range(n + 1) for i in range(n + 1 - j)]
        return np.array([(a * c[0] + b * c[1] + d * c[2]) / n for a, b, d in weights])
    rows = []
    for j in range(n + 1):
        left, right = ((n - j) * c[0] + j * c[3]) / n, ((n - j) * c[1] + j * c[2]) / n
        rows += [((n - i) * left + i * right) / n for i in range(n + 1)]
    return np.array(rows)


def fine_points(result, f):
    """Ids of the points of input face f's refinement."""
    parts = [
        part[polygon == f]
        for part, polygon in zip(result.faces, (result.triangle_polygon, result.quad_polygon))
    ]
    return np.unique(np.concatenate([p.reshape(-1) for p in parts]))


def as_set(points):
    return {tuple(p) for p in (points + 0.0).tolist()}


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize(
    "name, options",
    [(n, {}) for n in ("icosahedron", "cube", "torus_quads", "creature", "wavy_patch", "roof")]
    + [
        ("creature", o)
        for o in ({"pad_size": 0.5}, {"tension": 0.8}, {"energy": "total_curvature"})
    ],
    ids=str,
)
def test_outside_and_joint_are_linear_to_the_last_bit(name, options, joint):
    vertices, faces = meshes.ALL[name]()
    faces = as_lists(faces)
    region = np.arange(0, len(faces), 3)
    result = fair(vertices, faces, 2, region=region, joint=joint, measure=False, **options)
    assert np.array_equal(result.vertices[: len(vertices)], vertices) and result.report["converged"]
    outside = np.setdiff1d(np.arange(len(faces)), region)
    for f in outside:
        ids = fine_points(result, f)
        expected = lattice_points(vertices[faces[f]], 4)
        # interiors of faces bit for bit; along edges the same numbers may be added from the other
        # end
        distance = np.abs(result.vertices[ids][:, None] - expected[None]).max(2).min(1)
        assert len(ids) == len(expected) and distance.max() <= 1e-15 * np.abs(vertices).max()
        inner = expected[
            np.array([(expected == p).all(1).any() for p in result.vertices[ids]]).nonzero()[0]
        ]
        assert len(inner) > 0
    edge = {tuple(sorted(e)) for f in outside for e in zip(faces[f], [*faces[f][1:], faces[f][0]])}
    on_edges = as_set(
        np.concatenate(
            [[((4 - k) * vertices[a] + k * vertices[b]) / 4 for k in (1, 2, 3)] for a, b in edge]
        )
    )
    assert on_edges <= as_set(result.vertices)
    polyhedron = np.concatenate([lattice_points(vertices[faces[f]], 4) for f in region])
    inside = result.vertices[np.concatenate([fine_points(result, f) for f in region])]
    assert np.abs(inside[:, None] - polyhedron[None]).max(2).min(1).max() > 1e-3


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("cut", [False, True])
def test_flat_stays_flat(joint, cut):
    mesh = meshes.grid(5, 5)
    vertices, faces = meshes.cut_quads(mesh) if cut else mesh
    region = np.nonzero(np.abs(vertices[faces].mean(1)[:, :2] - 2.5).max(1) < 1.6)[0]
    result = fair(vertices, faces, 3, region=region, joint=joint)
    assert np.abs(result.vertices[:, 2]).max() < 1e-12
    # and uniform: the polyhedron is the minimizer
    linear = fair(vertices, faces, 3, region=[0], joint="position", boundary="linear").vertices
    assert np.abs(result.vertices - linear).max() < 1e-7


def slopes_and_curvatures(gap, joint, levels, **options):
    """At the joint, in the middle of a ramp's line: turn (radians), and second difference of the first row inside."""
    turns, curvatures = [], []
    for level in levels:
        mesh, region, (low, _) = ramp(6 if gap == 2 else 7, gap)
        line = profile(
            fair(*mesh, level, region=region, joint=joint, measure=False, **options), low, level
        )
        step = line[1] - line[0]
        turns.append(np.arctan2(step[2], step[0]))
        curvatures.append(np.linalg.norm(line[2] - 2 * line[1] + line[0]) * 4**level)
    return np.array(turns), np.array(curvatures)


@pytest.mark.parametrize("gap", [2, 3])
def test_what_each_joint_promises(gap):
    levels = (2, 3, 4, 5)
    position, _ = slopes_and_curvatures(gap, "position", levels)
    tangent, bent = slopes_and_curvatures(gap, "tangent", levels)
    curvature, faded = slopes_and_curvatures(gap, "curvature", levels)
    # the straight ramp has no energy: the fold is all at the joint
    assert np.abs(position - np.arctan(1 / gap)).max() < 1e-6
    assert (tangent < 0.4 * position).all() and (curvature < 0.5 * tangent).all()
    # first order: the turn over one step is half a step times the curvature of a clamped plate
    assert (tangent[1:] < 0.57 * tangent[:-1]).all()
    # that curvature converges to a number, and here to that of the cubic for gap = 2: 6 / gap**2
    assert (bent > 0.5).all()
    if gap == 2:
        assert np.abs(bent[-1] - 1.5) < 0.06
    # one order more
    assert (curvature[2:] < 0.29 * curvature[1:-1]).all()
    assert (faded[2:] < 0.6 * faded[1:-1]).all() and faded[-1] < 0.15 * bent[-1]


@pytest.mark.parametrize("joint", JOINTS)
def test_region_of_all_faces_is_none(joint):
    vertices, faces = meshes.creature()
    whole = fair(vertices, faces, 2, region=np.arange(len(faces))[::-1], joint=joint)
    plain = fair(vertices, faces, 2)
    assert np.array_equal(whole.vertices, plain.vertices)
    assert whole.report["energy"] == plain.report["energy"]


@pytest.mark.parametrize("joint", JOINTS)
def test_bad_faces_outside_do_no_harm(joint):
    vertices, faces = meshes.cut_quads(meshes.grid(6, 6))
    vertices[:, 2] = 0.2 * np.sin(vertices[:, 0]) * np.cos(vertices[:, 1])
    middle = vertices[faces].mean(1)
    region = np.nonzero(np.abs(middle[:, :2] - 3).max(1) < 1.1)[0]
    thin = vertices.copy()
    corner = np.nonzero((vertices[:, 0] == 0) & (vertices[:, 1] == 0))[0]
    thin[corner, :2] = [0.9999999, 0.9999998]  # all but on a neighbour: two needles
    good, bad = (fair(v, faces, 4, region=region, joint=joint) for v in (vertices, thin))
    assert (
        bad.report["converged"]
        and bad.report["iterations"][-1] <= good.report["iterations"][-1] + 1
    )
    inside = np.concatenate([fine_points(good, f) for f in region])
    assert np.abs(good.vertices[inside] - bad.vertices[inside]).max() < 1e-7


def test_creases_are_curves_inside_and_straight_outside():
    (vertices, faces), ridge = meshes.roof()
    vertices = vertices.copy()
    vertices[ridge, 2] += 0.1 * np.sin(2 * vertices[ridge, 1])
    region = np.nonzero(vertices[faces].mean(1)[:, 1] < 2)[0]
    result = fair(vertices, faces, 3, region=region, crease_edges=ridge)
    inside, outside = [], []
    for a, b in ridge.tolist():
        line = np.array([((8 - k) * vertices[a] + k * vertices[b]) / 8 for k in range(1, 8)])
        away = np.abs(result.vertices[:, None] - line[None]).max(2).min(0).max()
        (inside if vertices[[a, b], 1].max() <= 2 else outside).append(away)
    assert max(outside) == 0 and min(inside) > 1e-3
    assert as_set(np.sort(result.crease_edges, 1)) == as_set(np.sort(ridge, 1))


def test_only_inside_vertices_move():
    (vertices, faces), region, (low, high) = ramp(8, 4)
    vertices = vertices + 0.05 * np.random.default_rng(1).normal(size=vertices.shape) * [0, 0, 1]
    inside = (vertices[:, 0] > low) & (vertices[:, 0] < high) & (np.abs(vertices[:, 1] - 2) < 2)
    for options in (
        {"interpolation": "approximate", "tolerance": 0.05},
        {"interpolation": "approximate", "weights": np.ones(len(vertices))},
        {"interpolation": "approximate", "tolerance": 0.05, "pad_size": 0.5},
        {"epsilon": 0.05},
    ):
        result = fair(vertices, faces, 2, region=region, **options)
        moved = (result.vertices[: len(vertices)] != vertices).any(1)
        assert np.array_equal(moved, inside), options
        if "weights" not in options:
            assert np.linalg.norm(result.vertices[: len(vertices)] - vertices, axis=1).max() <= 0.05
