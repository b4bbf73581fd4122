# SPDX-License-Identifier: GPL-3.0-or-later
"""A border that meets a neighbour's: kinks and jumps of curvature along the joint."""

import discrete_fairing as df
import numpy as np
import pytest
from control_meshes import cut_quads as triangles
from discrete_fairing.joints.border_fits import border_of
from discrete_fairing.joints.borders import border_curve, mesh_arrays
from discrete_fairing.joints.turning import needed
from lattices import lattice_faces
from surface_measures import dihedrals

CORNERS = np.radians(30)


def sheet(place, us, vs):
    """(vertices, quads) of place(u, v) → (3, k), u slowly."""
    u, v = np.meshgrid(us, vs, indexing="ij")
    return np.stack(place(u.ravel(), v.ravel()), axis=1), lattice_faces(*u.shape)


def bonnet_and_fender():
    def crown(u):
        return 0.12 * np.sin(0.8 * np.pi * u + 0.3)

    def bonnet(u, v):
        return 1.4 * u, 1.2 * v, crown(u) + 0.25 * (1 - v * v * (1 + 0.2 * u))

    def fender(u, v):
        down = 0.35 * (1 - np.cos(1.3 * v)) + 0.12 * np.sin(1.3 * v)
        return 1.4 * u, 1.2 + 0.3 * np.sin(1.3 * v), crown(u) - 0.05 * u - down

    along = np.linspace(0, 1, 6)
    return sheet(bonnet, along, np.linspace(0, 1, 5)), sheet(fender, along, np.linspace(0, 1, 4))


def hull_and_deck():
    def side(degrees):
        def place(u, v):
            turn = np.radians(degrees[0] + (degrees[1] - degrees[0]) * v)
            width = 0.2 + 0.8 * np.sin(np.pi * (0.1 + 0.75 * u))
            over = np.maximum(np.sin(turn) - np.sin(np.radians(25)), 0)
            height = 0.7 * np.sin(turn) - 0.15 * over
            return 4 * u, width * np.cos(turn), height + 0.3 * (2 * u - 1) ** 2

        return place

    along = np.linspace(0, 1, 9)
    hull = sheet(side((-80, 25)), along, np.linspace(0, 1, 7))
    return hull, sheet(side((25, 90)), along, np.linspace(0, 1, 5))


def bottle_halves():
    height = np.array([0, 0.25, 0.5, 0.75, 1, 1.2, 1.4, 1.6, 1.8, 2.05, 2.3])
    radius = np.array([0.51, 0.52, 0.52, 0.51, 0.49, 0.46, 0.42, 0.34, 0.26, 0.21, 0.19])

    def half(first):
        def place(u, v):
            r = np.interp(v, height, radius)
            return r * np.cos(first + u), 0.8 * r * np.sin(first + u), v

        return sheet(place, np.linspace(0, np.pi, 7), height)

    return half(0.0), half(np.pi)


def seam(first, other):
    return df.joint((first.vertices, first.faces), (other.vertices, other.faces))


def seen_from(surface, points):
    """(k, 3): from the nearest points on the border of a surface."""
    return points - border_of(*mesh_arrays((surface.vertices, surface.faces))).at(points).point


def kinks_at_ends(met, first):
    """Degrees, at the ends of joints, which `joint` leaves out: between the surfaces' fits there."""
    own, other = (mesh_arrays((part.vertices, part.faces)) for part in (met, first))
    neighbour = border_of(*other)
    curve = border_curve(*own)
    on = np.linalg.norm(neighbour.at(curve.point).point - curve.point, axis=1) < 1e-9
    border = border_of(*own, only=curve.vertex[on])
    turn, _ = needed(border, neighbour.at(border.point))
    ends = np.bincount(border.ends.ravel()) == 1
    assert ends.sum() in (2, 4)
    return np.degrees(np.abs(turn[ends]).max())


PAIRS = {"bonnet": bonnet_and_fender, "hull": hull_and_deck, "bottle": bottle_halves}


def fair(mesh, levels, **settings):
    return df.fair(*mesh, levels, corner_angle=CORNERS, **settings)


def largest_turn(result):
    """Between neighbouring triangles, in degrees."""
    triangle, quad = result.faces
    corners = np.concatenate([triangle, quad[:, :3], quad[:, [0, 2, 3]]])
    return dihedrals(result.vertices, corners).max()


def quads(mesh):
    return mesh


# degrees: the halves of the bottle met at up to 34, over faces that turn by 30
@pytest.mark.parametrize("make", [quads, triangles])
@pytest.mark.parametrize("levels", [3, 4])
@pytest.mark.parametrize("pair", PAIRS)
def test_tangents_join(pair, levels, make):
    """Triangles once had kinks of 1.4 degrees, at ends of 5.5, and sides of the bottle folded by 43."""
    fixed, other = map(make, PAIRS[pair]())
    first, before = fair(fixed, levels), fair(other, levels)
    assert np.degrees(seam(before, first).kink.max()) > 5
    met = fair(other, levels, neighbour=(first.vertices, first.faces))
    joint = seam(met, first)
    assert len(joint.kink) >= 5 * 2**levels - 3 and joint.gap.max() < 1e-12
    assert np.degrees(joint.kink.max()) < 0.05 and kinks_at_ends(met, first) < 0.05
    assert largest_turn(met) < 2 * largest_turn(before)
    # ids, faces, and the control vertices, bit for bit
    assert all(np.array_equal(a, b) for a, b in zip(met.faces, before.faces))
    assert np.array_equal(met.vertices[: len(other[0])], other[0])


@pytest.mark.parametrize("make", [quads, triangles])
@pytest.mark.parametrize("levels", [3, 4])
@pytest.mark.parametrize("pair", PAIRS)
def test_curvature_joins(pair, levels, make):
    """Also beside the ends of the joint, where curvature once jumped by 76 to 99 %."""
    fixed, other = map(make, PAIRS[pair]())
    first = fair(fixed, levels)
    met = fair(other, levels, neighbour=(first.vertices, first.faces), joint="curvature")
    joint = seam(met, first)
    assert np.degrees(joint.kink.max()) < 0.05 and joint.jump.max() < 0.03
    assert kinks_at_ends(met, first) < 0.05


@pytest.mark.parametrize("levels", [3, 4])
@pytest.mark.parametrize("pair", PAIRS)
def test_both_meet_half_way(pair, levels):
    """Each turns by half of the kink, towards the other as it was."""
    meshes = PAIRS[pair]()
    free = [fair(mesh, levels) for mesh in meshes]
    before = seam(*free)
    met = [
        fair(mesh, levels, neighbour=(other.vertices, other.faces), halfway=True)
        for mesh, other in zip(meshes, free[::-1])
    ]
    joint = seam(*met)
    assert len(joint.kink) >= 5 * 2**levels - 3 and joint.gap.max() < 1e-12
    assert kinks_at_ends(*met) < 0.05
    assert np.degrees(before.kink.max()) > 7 and np.degrees(joint.kink.max()) < 0.05
    for surface, own, other in zip(met, free, free[::-1]):
        turned = np.degrees(seam(surface, other).kink)
        assert turned == pytest.approx(np.degrees(seam(own, other).kink) / 2, abs=0.05)


def keel_halves(deadrise):
    """Two mirrored halves of a hull with a sharp keel: `deadrise` in degrees, up to its chine."""

    def half(side):
        def place(u, v):
            wide = 0.25 + 0.75 * np.sin(np.pi * (0.15 + 0.7 * u))
            out = wide * np.sin(0.45 * np.pi * v) * np.cos(np.radians(deadrise))
            up = wide * (v * np.sin(np.radians(deadrise)) + 0.35 * v**3)
            return 4 * u, side * out, up + 0.3 * (2 * u - 1) ** 2

        return sheet(place, np.linspace(0, 1, 8), np.linspace(0, 1, 6))

    return half(1), flipped(half(-1))


@pytest.mark.parametrize("joint", ["tangent", "curvature"])
@pytest.mark.parametrize(
    "deadrise, meets", [(10, (True, True)), (45, (False, True)), (80, (False, False))]
)
def test_halves_meet_at_a_sharp_keel_without_crossing(deadrise, meets, joint):
    """They once crossed the middle, by 6 % of the beam, and folded back by 180 degrees without a word."""
    free = [fair(mesh, 3) for mesh in keel_halves(deadrise)]
    before = np.degrees(seam(*free).kink.max())
    for halfway, smooth in zip((False, True), meets):
        met = [
            fair(mesh, 3, neighbour=(o.vertices, o.faces), halfway=halfway, joint=joint)
            for mesh, o in zip(keel_halves(deadrise), free[::-1])
        ]
        starboard, port = met if halfway else (free[0], met[1])
        assert starboard.vertices[:, 1].min() > -1e-12 and port.vertices[:, 1].max() < 1e-12
        found = seam(port, starboard)
        assert found.gap.max() < 1e-12
        assert np.degrees(found.kink.max()) == pytest.approx(0 if smooth else before, abs=0.05)
        told = [warning["code"] for warning in port.report["warnings"]]
        assert told == ([] if smooth else ["JOINT_NOT_MET"])


@pytest.mark.parametrize("weight", [1.0, 0.5])
def test_a_crease_that_ends_on_a_joint_is_named_unless_it_fades_there(weight):
    bonnet, fender = bonnet_and_fender()
    line = [(8 + k, 9 + k) for k in range(3)]  # across, from the joint
    fender[0][8:11, 2] += weight**2 * np.array([0.1, 0.08, 0.06])
    bonnet[0][12:15, 2] += weight**2 * np.array([0.03, 0.04, 0.1])
    first = fair(bonnet, 3)
    met = fair(
        fender,
        3,
        neighbour=(first.vertices, first.faces),
        **({"crease_edges": line} if weight == 1 else {"soft_creases": (line, [weight] * 3)}),
    )
    warnings = [w for w in met.report["warnings"] if w["code"] == "JOINT_NOT_MET"]
    if weight == 1:
        assert warnings[0]["elements"] == [8]
    else:
        assert not warnings and np.degrees(seam(met, first).kink.max()) < 0.05


def flipped(mesh):
    return mesh[0], mesh[1][:, ::-1]


def test_both_meet_half_way_in_curvature_whichever_way_their_faces_turn():
    bonnet, fender = bonnet_and_fender()
    free = [fair(mesh, 3) for mesh in (bonnet, flipped(fender))]
    met = [
        fair(mesh, 3, neighbour=(o.vertices, o.faces), halfway=True, joint="curvature")
        for mesh, o in zip((bonnet, flipped(fender)), free[::-1])
    ]
    joint, before = seam(*met), seam(*free)
    assert np.degrees(joint.kink.max()) < 0.05 and joint.jump.max() < 0.03
    assert joint.bend[:, 0] == pytest.approx(before.bend.mean(axis=1), abs=0.03 * joint.largest)


@pytest.mark.parametrize("levels", [3, 4])
@pytest.mark.parametrize("halfway", [False, True])
def test_ripples_beside_a_joint_are_told_or_avoided(levels, halfway):
    """Curvatures that alternate along the border let a bonnet's faces fold by 26 degrees, by 116 half way."""
    bonnet, fender = bonnet_and_fender()
    first = fair(fender, levels)
    goal = {"neighbour": (first.vertices, first.faces), "halfway": halfway}
    smooth = largest_turn(fair(bonnet, levels, **goal))
    met = fair(bonnet, levels, **goal, joint="curvature")
    told = [w["code"] for w in met.report["warnings"]]
    if levels == 3:
        assert told == ["JOINT_JAGGED"]
    else:
        assert told == ["JOINT_NOT_MET"] and largest_turn(met) == pytest.approx(smooth)


@pytest.mark.parametrize("joint", ["tangent", "curvature"])
def test_a_solver_meets_the_neighbour_after_every_move(joint):
    fixed, (points, faces) = hull_and_deck()
    first = fair(fixed, 3)
    goal = {"neighbour": (first.vertices, first.faces), "joint": joint, "corner_angle": CORNERS}
    solver = df.Solver(points, faces, 3, **goal)
    assert np.array_equal(solver.solve().vertices, df.fair(points, faces, 3, **goal).vertices)
    moved = points.copy()
    moved[np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1)), 2] += 0.03
    met = solver.solve(moved)
    seen = seam(met, first)
    assert np.degrees(seen.kink.max()) < 0.05 and seen.gap.max() < 1e-12
    assert joint == "tangent" or seen.jump.max() < 0.03
    # a border vertex that leaves the neighbour takes its edges along
    border = border_of(*mesh_arrays((points, faces))).vertex
    on = border[np.linalg.norm(seen_from(first, points[border]), axis=1) < 1e-9]
    moved[on[np.argmax(points[on, 0])], 2] += 0.3
    left = seam(solver.solve(moved), first)
    assert len(seen.kink) - 8 <= len(left.kink) < len(seen.kink)


def curved(u, v):
    return (
        u,
        v + 0.1 * np.sin(3 * u),
        0.3 * np.sin(2 * u + v) + 0.2 * u * u * v + 0.2 * np.cos(2 * v),
    )


@pytest.mark.parametrize("make", [quads, triangles])
def test_one_surface_in_two_parts_has_no_kink(make):
    """What `joint` finds on an analytic surface falls at least with the third power of the step."""
    kinks = []
    for count in (16, 32):
        v = np.linspace(0, 1, count + 1)
        a, b = (make(sheet(curved, np.linspace(u, u + 0.5, count + 1), v)) for u in (0.0, 0.5))
        found = df.joint(a, b)
        assert len(found.kink) == count - 1 and found.gap.max() == 0 and found.jump.max() < 0.015
        kinks.append(np.degrees(found.kink.max()))
    assert kinks[0] < 0.01 and kinks[1] < kinks[0] / 6


def test_joint_measures_a_fold_and_a_gap():
    flat = sheet(lambda u, v: (u, -v, 0 * u), np.linspace(0, 1, 9), np.linspace(0, 1, 9))
    flat = flat[0], flat[1][:, ::-1]
    slope = sheet(
        lambda u, v: (u, v * np.cos(0.3) + 0.01, v * np.sin(0.3)),
        np.linspace(0, 1, 9),
        np.linspace(0, 1, 9),
    )
    found = df.joint(slope, flat)
    assert found.kink == pytest.approx(0.3) and found.gap == pytest.approx(0.01)
    assert len(df.joint(slope, (flat[0] - [0, 9, 0], flat[1])).vertex) == 0


def test_a_long_border_of_a_narrow_strip_is_met():
    """What the fits hardly see must not grow: by undamped least squares it kept a kink of 1.3 degrees."""

    def strip(low, high, bend):
        x, y = np.meshgrid(np.linspace(0, 1, 33), np.linspace(low, high, 4), indexing="ij")
        points = np.stack([x, y, 0.1 * np.sin(5 * x) + bend * y**2], axis=-1).reshape(-1, 3)
        return points, lattice_faces(33, 4)

    other = df.fair(*strip(-0.2, 0, -0.3), 3)
    met = df.fair(*strip(0, 0.2, 0.5), 3, neighbour=(other.vertices, other.faces))
    joint = df.joint((met.vertices, met.faces), (other.vertices, other.faces))
    assert not met.report["warnings"] and np.abs(joint.kink).max() < 2e-4
