# SPDX-License-Identifier: GPL-3.0-or-later
"""Boundary and crease curves depend on their own vertices alone."""

import control_meshes as meshes
import numpy as np
import pytest
import tight
from surface_measures import turns
from surfaces import boundary_vertices, output_faces, random_rotation, size_of


def rows(points: np.ndarray) -> set:
    """Points to the last bit."""
    return {p.tobytes() for p in np.ascontiguousarray(points + 0.0)}


def boundary_points(result) -> np.ndarray:
    return result.vertices[boundary_vertices(output_faces(result))]


def polygon(count: int = 9) -> np.ndarray:
    """A closed polyline in space, of uneven steps."""
    angle = 2 * np.pi * (np.arange(count) + 0.3 * np.sin(np.arange(count))) / count
    return np.stack([np.cos(angle), np.sin(angle), 0.4 * np.sin(2 * angle)], -1) / 3 + 0.1


def caps(rim: np.ndarray):
    """Three surfaces of different faces, valences and order of vertices that end in the same polyline."""
    n = len(rim)
    k = np.arange(n)
    after = (k + 1) % n
    cone = np.concatenate([rim, [[0.1, 0.2, 0.9]]]), np.stack([k, after, 0 * k + n], -1)
    inner = 0.5 * rim + [0.3, 0, 0.4]
    frustum = np.stack([k, after, n + after, n + k], -1).tolist() + [list(range(n, 2 * n))]
    other = np.concatenate([[[0.0, -0.3, -0.5]], rim[::-1]])
    turned = np.stack([0 * k, k + 1, after + 1], -1)
    return [cone, (np.concatenate([rim, inner]), frustum), (other, turned)]


@pytest.mark.parametrize("exponent", [0.5, 1.0, 0.0])
@pytest.mark.parametrize("corners", [False, True])
def test_the_same_polyline_gives_the_same_curve(exponent, corners):
    """Bit for bit, whatever the interior, the numbering and the direction."""
    rim = polygon()
    found = []
    for vertices, faces in caps(rim):
        chosen = (
            [int(np.argwhere((vertices == rim[k]).all(1))[0, 0]) for k in (2, 5)]
            if corners
            else None
        )
        result = tight.fair(vertices, faces, 3, metric_exponent=exponent, corner_vertices=chosen)
        found.append(rows(boundary_points(result)))
        assert len(found[-1]) == 8 * len(rim)
    assert found[0] == found[1] == found[2]


@pytest.mark.parametrize(
    "option", [{"corner_angle": 0.75}, {"corner_angle": 10.0}, {"boundary": "linear"}], ids=str
)
@pytest.mark.parametrize(
    "surface", [{}, {"pad_size": 0.5}, {"tension": 1}, {"energy": "total_curvature"}], ids=str
)
def test_the_same_polyline_under_other_rules(option, surface):
    """The curve is that of the thin plate on point forces, whatever the surface is."""
    found = [
        rows(boundary_points(tight.fair(*cap, 2, **option, **options)))
        for cap in caps(polygon())
        for options in ({}, surface)
    ]
    assert all(curve == found[0] for curve in found)


def test_a_crease_and_a_boundary_of_the_same_polyline_are_the_same_curve():
    """The drum's rim as a crease, and as the boundary of its upper half."""
    (vertices, faces), loop, above, _ = meshes.drum()
    whole = tight.fair(vertices, faces, 3, crease_edges=loop)
    kept = np.append(np.unique(loop), above)
    place = np.full(len(vertices), -1)
    place[kept] = np.arange(len(kept))
    upper = place[faces[np.isin(faces, kept).all(1)]]
    half = tight.fair(vertices[kept], upper, 3)
    assert rows(boundary_points(half)) <= rows(whole.vertices)


def test_curve_boundary_is_smooth_and_linear_is_not():
    """On a curve the turn at a control vertex halves with each level; on the polyline it stays."""
    vertices, faces = meshes.fan(8)

    def turn(levels, boundary):
        result = tight.fair(vertices, faces, levels, boundary=boundary)
        around = [w for f in result.triangles.tolist() if 1 in f for w in f if w != 1]
        a, b = (w for w in set(around) if around.count(w) == 1)
        before, after = (
            result.vertices[1] - result.vertices[a],
            result.vertices[b] - result.vertices[1],
        )
        return np.arccos(before @ after / np.linalg.norm(before) / np.linalg.norm(after))

    smooth = [turn(levels, "curve") for levels in (1, 2, 3, 4)]
    assert all(0.4 < b / a < 0.6 for a, b in zip(smooth, smooth[1:]))
    straight = [turn(levels, "linear") for levels in (1, 4)]
    assert straight[0] == pytest.approx(straight[1], abs=1e-12)


@pytest.mark.parametrize("ends", ["corner_angle", "corner_vertices"])
def test_corners_split_a_curve(ends):
    """A square's straight sides stay straight between corners, and bulge without."""
    vertices, faces = meshes.grid(3, 3)
    vertices[5] += [0, 0, 1]
    corners = (
        {"corner_angle": 1.0} if ends == "corner_angle" else {"corner_vertices": [0, 3, 12, 15]}
    )

    def off_the_square(**options):
        points = boundary_points(tight.fair(vertices, faces, 3, **options))
        return np.abs(np.abs(points[:, :2] - 1.5).max(1) - 1.5).max()

    assert off_the_square(**corners) < 1e-12
    assert off_the_square() > 0.01
    assert off_the_square(corner_angle=1.6) > 0.01


@pytest.mark.parametrize(
    "flip, pad_size, most", [(False, 0, 1e-9), (True, 0, 1e-9), (False, 1, 1e-5), (True, 1, 1e-5)]
)
def test_moving_one_side_of_a_crease_loop_leaves_the_other(flip, pad_size, most):
    """The curve stays to the last bit, and the far side as far as it is solved: one system serves both sides."""
    (vertices, faces), loop, above, below = meshes.drum()
    here, there = (below, above) if flip else (above, below)
    moved = vertices.copy()
    moved[here[1]] += [0.2, 0.1, 0.15 if not flip else -0.15]
    options = {"crease_edges": loop, "relative_residual": 1e-11, "pad_size": pad_size}
    still, after = (tight.fair(v, faces, 3, **options) for v in (vertices, moved))
    control = np.append(np.unique(loop), there)
    cells = np.isin(still.triangle_polygon, np.nonzero(np.isin(faces, control).all(1))[0])
    side = np.unique(still.faces[0][cells])
    assert len(side) > 500
    difference = np.abs(still.vertices[side] - after.vertices[side]).max()
    assert difference <= most * size_of(vertices)
    curve = np.intersect1d(side, still.faces[0][~cells])
    assert still.vertices[curve].tobytes() == after.vertices[curve].tobytes()
    smooth, other = (
        tight.fair(v, faces, 3, relative_residual=1e-11).vertices for v in (vertices, moved)
    )
    assert np.abs(smooth[side] - other[side]).max() > 1e-4


def crease_and_inner_angles(result, on_crease):
    faces = result.faces[1]
    edges, _, angle = turns(result.vertices, faces)
    crease = on_crease(result.vertices[edges]).all(1)
    return angle[crease], angle[~crease]


def test_a_roof_keeps_its_ridge_and_smooths_its_slopes():
    (vertices, faces), ridge = meshes.roof()
    sharp, inside = [], []
    for levels in (2, 3, 4):
        result = tight.fair(vertices, faces, levels, crease_edges=ridge)
        at_ridge, elsewhere = crease_and_inner_angles(result, lambda p: np.abs(p[..., 0]) < 1e-12)
        assert len(at_ridge) == 4 * 2**levels
        sharp.append(at_ridge.min())
        inside.append(elsewhere.max())
    first, second = np.abs(np.diff(sharp))
    assert min(sharp) > 0.95 and second < 0.7 * first < 0.03
    assert all(fine < 0.7 * coarse for coarse, fine in zip(inside, inside[1:]))
    smooth = tight.fair(vertices, faces, 3)
    assert crease_and_inner_angles(smooth, lambda p: np.abs(p[..., 0]) < 1e-3)[0].max() < 0.6


def test_a_box_with_creases_stays_a_box():
    """Every side is flat, every edge straight: the surface is the box itself."""
    (vertices, faces), creases = meshes.box_with_creases()
    rotation = random_rotation(3)
    result = tight.fair(vertices @ rotation.T, faces, 3, crease_edges=creases)
    assert np.abs(np.abs(result.vertices @ rotation).max(1) - 1).max() < 1e-9
    assert result.report["energy"]["result"]["thin_plate"] < 1e-9
    finest = result.report["levels"][-1]
    assert finest["converged"] and finest["residual"] <= 1e-8, (
        "2.7 where the polyhedron is the solution"
    )


def test_crease_angle_finds_the_same_creases():
    (vertices, faces), creases = meshes.box_with_creases()
    vertices = vertices + 0.02 * np.random.default_rng(0).normal(size=vertices.shape)
    given = tight.fair(vertices, faces, 2, crease_edges=creases)
    found = tight.fair(vertices, faces, 2, crease_angle=0.8)
    assert np.array_equal(given.vertices, found.vertices)
    assert not np.allclose(
        found.vertices, tight.fair(vertices, faces, 2, crease_angle=2.0).vertices
    )
    assert np.array_equal(
        tight.fair(vertices, faces, 2, crease_angle=2.0).vertices,
        tight.fair(vertices, faces, 2).vertices,
    )


def rounded_box(chords: int):
    """A box of 75 by 150 by 9 with round upright edges, in the precision of files."""
    angle = np.arange(4)[:, None] * np.pi / 2 + np.linspace(0, np.pi / 2, chords + 1)
    arc = 9 * np.stack([np.cos(angle), np.sin(angle)], -1)
    centre = [[28.5, 66], [-28.5, 66], [-28.5, -66], [28.5, -66]]
    rim = (arc + np.array(centre)[:, None]).reshape(-1, 2).astype(np.float32).astype(float)
    n, k = len(rim), np.arange(len(rim))
    after = (k + 1) % n
    vertices = np.concatenate([np.c_[rim, 0 * k], np.c_[rim, 0 * k + 9]])
    sides = np.stack([k, after, n + after, n + k], -1).tolist()
    return vertices, [k[::-1].tolist(), (n + k).tolist(), *sides]


@pytest.mark.parametrize("chords", [2, 3, 5])
def test_sides_of_a_rounded_box_stay_flat_beside_its_round_edges(chords):
    """Two chords fold by 45 degrees, so the rims end there; three fold by 30 exactly and do not."""
    vertices, faces = rounded_box(chords)
    result = tight.fair(vertices, faces, 3, crease_angle=np.radians(30))
    rims = 2 * 4 * (chords + 1)
    assert len(result.crease_edges) == rims + (4 if chords == 2 else 0)
    out = np.abs(result.vertices[:, :2]) - [37.5, 75]
    assert out.max() < 0.1  # 2.3, 1.4 and 0.4 by splines through sides and round edges
    on_rim = np.abs(result.vertices[:, 2] - 4.5) > 4.5 - 1e-9
    assert out[on_rim].max() < 1e-4


def test_a_corner_inside_a_surface_is_the_tip_of_a_cone():
    """The surface may come to a point there, with less energy; elsewhere it does not."""
    vertices, faces = meshes.closed_pole(12)
    smooth, tip = (tight.fair(vertices, faces, 3, corner_vertices=c) for c in (None, [12]))
    assert (
        tip.report["energy"]["result"]["thin_plate"]
        < smooth.report["energy"]["result"]["thin_plate"]
    )
    assert np.array_equal(tip.vertices[:14], vertices)
