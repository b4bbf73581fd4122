# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces meant to be flat stay flat beside tight rims, and the rest blends into them."""

import discrete_fairing as df
import flat_parts
import numpy as np
import pytest
from catmull_clark import subdivide
from discrete_fairing.flats import SPACING
from surface_measures import turns

LEVEL = 3


def flatness(part, points, faces, owner):
    """(how far flat faces are off their planes as a share of the size, their largest turn in degrees).

    `faces`: lists of arrays (k, 3 | 4), `owner`: of each, the control face of every one."""
    vertices, polygons, flat, _ = part
    off = turn = 0.0
    for refined, of in zip(faces, owner):
        for f in flat:
            own = points[refined[of == f]]
            if not len(own):
                continue
            a, b, c = vertices[polygons[f][:3]]
            normal = np.cross(b - a, c - a)
            normal /= np.linalg.norm(normal)
            off = max(off, np.abs((own - a) @ normal).max())
            first, second = own[:, 2] - own[:, 0], own[:, -1] - own[:, 1]
            across = np.cross(first, second)
            across /= np.linalg.norm(across, axis=1)[:, None]
            turn = max(turn, np.degrees(np.arccos(np.clip(np.abs(across @ normal), 0, 1))).max())
    return off / np.ptp(vertices, axis=0).max(), turn


def of_result(part, found):
    return flatness(part, found.vertices, found.faces, (found.triangle_polygon, found.quad_polygon))


def of_subdivision(part):
    points, faces, owner = part[0], part[1], np.arange(len(part[1]))
    for _ in range(LEVEL):
        owner = np.repeat(owner, [len(face) for face in faces])
        points, faces = subdivide(points, faces)[:2]
    return flatness(part, points, [np.array(faces)], [owner])


@pytest.mark.parametrize("name", flat_parts.PARTS)
@pytest.mark.parametrize("size", range(3))
def test_flat_faces_are_flat_and_nearer_than_subdivision_surface(name, size):
    make, sizes = flat_parts.PARTS[name]
    part = make(*sizes[size])
    found = df.fair(part[0], part[1], LEVEL, flat_faces=part[2])
    assert np.array_equal(found.vertices[: len(part[0])], part[0])
    off, turn = of_result(part, found)
    beside = of_subdivision(part)
    assert off < 1e-12 and turn < 0.1 * beside[1]
    assert of_result(part, df.fair(part[0], part[1], LEVEL))[0] > 2e-3


def test_flat_faces_move_where_their_vertices_do():
    points, faces, flat, _ = flat_parts.rounded_box(90, 60, 30, 4)
    found = df.fair(points, faces, 2, flat_faces=flat, tolerance=0.5)
    corners = np.unique(np.concatenate([faces[f] for f in flat]))
    assert np.abs(found.vertices[corners] - points[corners]).max(axis=1).min() > 0.05


def test_a_region_that_only_touches_is_tangent_to_flats_inside():
    points, faces, flat, _ = flat_parts.rounded_box(90, 60, 30, 4)
    region = np.setdiff1d(np.arange(len(faces)), flat[:1])
    kept = {"flat_faces": flat[1:], "metric_exponent": SPACING}
    found = df.fair(points, faces, LEVEL + 1, region=region, joint="position", **kept)
    _, pairs, angles = turns(found.vertices, found.faces[1])
    rim = (found.quad_polygon[pairs] == flat[-1]).sum(axis=1) == 1
    assert np.degrees(angles[rim].max()) < 3


def test_a_flat_cap_in_a_crease_follows_its_curve():
    points, faces = flat_parts.chamfered_cylinder(16, "")
    caps = [f for f, face in enumerate(faces) if len(face) == 16]
    rims = [pair for f in caps for pair in zip(faces[f], np.roll(faces[f], -1))]
    found = df.fair(points, faces, LEVEL, flat_faces=caps, crease_edges=rims)
    # caps are split into triangles, walls are quads
    rim = np.intersect1d(*found.faces)
    radius = np.hypot(*found.vertices[rim, :2].T)
    assert len(rim) == 2 * 16 * 2**LEVEL
    assert radius.min() > 0.998 * radius.max()  # chords have 0.981
    off = of_result((points, faces, caps, None), found)[0]
    assert off < 1e-4


def test_other_calls_know_flat_faces():
    points, faces, flat, _ = flat_parts.rounded_box(90, 60, 30, 4)
    found = df.fair(points, faces, 2, flat_faces=flat).vertices
    assert (
        np.abs(df.Solver(points, faces, 2, flat_faces=flat).solve(points).vertices - found).max()
        < 1e-2
    )
    parts = [piece.fair() for piece in df.pieces(points, faces, 2, count=2, flat_faces=flat)]
    assert np.abs(df.join(parts).vertices - found).max() < 1e-2
    twice = [*faces, faces[0]]
    assert (
        np.abs(df.fair(points, twice, 2, repair="mend", flat_faces=flat).vertices - found).max()
        < 1e-9
    )
    with pytest.raises(df.FairingError, match="flat_faces"):
        df.fair(points, faces, flat_faces=[len(faces)])


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("sides", [16, 44])
def test_walls_around_a_cylinder_stay_straight_and_bend_across(sides, triangles):
    points, faces = flat_parts.chamfered_cylinder(sides, "rims" if triangles else "")
    kept = df.find_flats(points, faces)
    assert len(kept) == sides + 2 if not triangles else len(kept) == 2 * sides + 2 * (sides - 2)
    found = df.fair(points, faces, LEVEL, flat_faces=kept, metric_exponent=SPACING).vertices
    radius = np.hypot(*found[:, :2].T)
    on_wall = (found[:, 2] > 1.5) & (found[:, 2] < 48.5)
    assert np.abs(radius[on_wall] - 12.5).max() < 0.004 * 12.5 and radius.max() < 1.004 * 12.5
    assert np.abs(found[:, 2] - 25.0).max() < 25.001
    plain = df.fair(points, faces, LEVEL, metric_exponent=SPACING).vertices
    assert np.hypot(*plain[:, :2].T).max() > 1.1 * 12.5


def test_a_cap_of_many_faces_stays_plane():
    """At this exponent the angles at its middle would be one and a half turns."""
    points, faces, flat, _ = flat_parts.turned(
        [
            (0, 0.0, "flat"),
            (18.5, 0.0, ""),
            (20.0, 1.5, ""),
            (20.0, 4.5, ""),
            (18.5, 6.0, "flat"),
            (0, 6.0, ""),
        ],
        32,
    )
    found = df.fair(points, faces, LEVEL, flat_faces=flat, metric_exponent=SPACING)
    assert found.report["converged"]
    height = found.vertices[:, 2]
    assert height.min() > -1e-3 and height.max() < 6.001
    assert np.hypot(*found.vertices[:, :2].T).max() < 1.02 * 20


def bar(sides, start):
    """Half a bar of flats around its axis, one face long, between rounded ends; its walls come last."""
    angle = start + np.pi * np.arange(sides + 1) / sides
    profile = [(4.0, 0.0), (4.7, 0.3), (5.0, 1.0), (4.0, 21.0), (3.7, 21.7), (3.0, 22.0)]
    points = np.array([(r * np.cos(a), r * np.sin(a), z) for r, z in profile for a in angle])
    k = np.arange(sides)
    bands = [
        np.stack([k, k + 1, k + sides + 2, k + sides + 1], axis=1) + b * (sides + 1)
        for b in (0, 1, 3, 4, 2)
    ]
    return points, np.concatenate(bands)


def test_a_box_may_be_flat_all_around():
    """Its faces meet at sharp folds: each is a part of its own."""
    cube = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    found = df.fair(cube, sides, LEVEL, flat_faces=range(6), metric_exponent=SPACING).vertices
    assert np.array_equal(found[:8], cube) and np.abs(found).max() < 2.0


@pytest.mark.parametrize("sides", [4, 9])
def test_walls_of_an_open_cone_are_straight(sides):
    """The first and the last wall have one neighbour each; borders are straight anyway."""
    points, faces = bar(sides, 0.3)
    walls = np.flatnonzero(np.arange(len(faces)) >= 4 * sides)
    assert df.find_flats(points, faces).tolist() == walls.tolist()

    def bend(**settings):
        found = df.fair(
            points, faces, LEVEL, metric_exponent=SPACING, boundary="linear", **settings
        )
        own = found.vertices[(found.vertices[:, 2] > 1.1) & (found.vertices[:, 2] < 20.9)]
        cone = 5.0 - (own[:, 2] - 1.0) / 20.0
        return np.abs(np.hypot(*own[:, :2].T) - cone)

    assert bend(flat_faces=walls).max() < 1.05 * (1 - np.cos(np.pi / sides / 2)) * 5
    assert bend().max() > 0.3


@pytest.mark.parametrize("size", [(40, 30, 20, 2), (150, 75, 9, 2.5)])
def test_rims_turn_by_half_on_a_finer_level_and_are_round(size):
    """An edge between a flat face and its rim was a hinge, as wide as a cell of the flat."""
    points, faces, *_ = flat_parts.rounded_box(*size)
    kept = df.find_flats(points, faces)
    sharpest, off = [], []
    for level in (LEVEL, LEVEL + 1):
        found = df.fair(points, faces, level, flat_faces=kept, metric_exponent=SPACING)
        sharpest.append(turns(found.vertices, found.faces[1])[2].max())
        out = np.abs(found.vertices) - (np.array(size[:3]) / 2 - size[3])
        far = np.linalg.norm(np.maximum(out, 0), axis=1) + np.minimum(out.max(axis=1), 0)
        off.append(np.abs(far - size[3]).max() / max(size[:3]))
    assert sharpest[1] < 0.6 * sharpest[0]
    assert max(off) < 5e-4


def section(height, wall, size):
    """(inset, z) of a vessel: its rims, of two chords, from the base to the floor."""
    lip = height - size
    profile = flat_parts.rim(-size, size, size, -np.pi / 2)
    profile += flat_parts.rim(-size, lip, size, 0.0)
    profile += flat_parts.rim(size - wall, lip, size, np.pi / 2)
    profile += flat_parts.rim(-size - wall, wall + size, size, 0.0, -np.pi / 2)
    return [(-away, z) for away, z in profile]


def test_a_cup_is_round_and_its_flats_have_round_outlines():
    """Its rims, of two chords, are narrower than the chords around are far from a circle, 0.34."""
    radius, height, wall, size, sides = 40.0, 90.0, 4.0, 1.0, 24
    inner, lip = radius - wall, height - size
    rings = [(radius - inset, z, "") for inset, z in section(height, wall, size)]
    points, faces, *_ = flat_parts.turned([(0, 0.0, ""), *rings, (0, wall, "")], sides)
    found = df.fair(points, faces, LEVEL, interpolation="auto").vertices
    assert np.array_equal(found[: len(points)], points)
    away, z = np.hypot(*found[:, :2].T), found[:, 2]
    turn = np.degrees(np.arctan2(found[:, 1], found[:, 0])) * sides / 360
    between = np.abs(turn - np.floor(turn) - 0.5) < 1e-6
    on_lip, on_floor, on_base = (
        away[between & (np.abs(z - level) < 1e-9)] for level in (height, wall, 0.0)
    )
    ends = [on_lip.max(), on_lip.min(), on_floor.max(), on_base.max()]
    assert np.allclose(ends, [radius - size, inner + size, inner - size, radius - size], atol=0.01)
    walls = (z > size) & (z < lip) & (away > radius - wall / 2)
    assert np.abs(away[walls] - radius).max() < 0.08


@pytest.mark.parametrize("size", [0.5, 1.5])
def test_rims_of_a_box_with_round_corners_are_straight_between_them(size):
    """They waved by more than their width: beside a floor a hundred times as wide they were hinges."""
    box = [
        flat_parts.rounded_outline(160 - 2 * inset, 100 - 2 * inset, 20 - inset, z)
        for inset, z in section(60.0, 4.0, size)
    ]
    points, faces = flat_parts.stacked(box)
    found = df.fair(points, faces, LEVEL, interpolation="auto")
    assert turns(found.vertices, found.faces[1])[2].max() < 0.3
    middle = found.vertices[np.abs(found.vertices[:, 0]) < 59]
    inset, z = 50 - np.abs(middle[:, 1]), middle[:, 2]
    walls = (z > 4 + size) & (z < 60 - size)
    assert np.minimum(np.abs(inset), np.abs(inset - 4))[walls].max() < 0.005
    lip = (z > 60 - size) & (inset < size)
    assert np.abs(np.hypot(inset - size, z - 60 + size) - size)[lip].max() < 0.1 * size
    if size > 1:
        start = df.fair(points, faces, LEVEL, interpolation="auto", pad_size=0).report["levels"][2]
        assert start["residuals"][0] < 2  # 10 where prolongation bent straight faces


def test_straight_strips_beside_a_fan_are_as_even_as_the_fan():
    """A flat of quads that fan out bent the chart around the outline's vertices, so that strips were stiff across."""

    def outline(inset, z):
        arcs = flat_parts.rounded_outline(80 - 2 * inset, 80 - 2 * inset, 10 - inset, z)
        corners = arcs.reshape(4, -1, 3)
        middles = (corners[:, -1] + np.roll(corners[:, 0], -1, axis=0)) / 2
        return np.concatenate([corners, middles[:, None]], axis=1).reshape(-1, 3)

    rims = flat_parts.rim(-2, 2, 2, -np.pi / 2) + flat_parts.rim(-2, 6, 2, 0.0)
    rows = [outline(-away, z) for away, z in rims]
    disc = 22 * rows[-1] / np.linalg.norm(rows[-1][:, :2], axis=1)[:, None]
    points, faces = flat_parts.stacked([*rows, np.column_stack([disc[:, :2], rows[-1][:, 2]])])
    found = df.fair(points, faces, LEVEL, interpolation="auto").vertices
    rim = found[(np.abs(found[:, 0]) < 29) & (found[:, 1] > 38) & (found[:, 2] > 6)]
    assert np.abs(np.hypot(rim[:, 1] - 38, rim[:, 2] - 6) - 2).max() < 0.05
