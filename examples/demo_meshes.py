# SPDX-License-Identifier: GPL-3.0-or-later
"""Three control meshes of the project's own, in plain NumPy: a faceted sphere, a boat hull with creases, a shape of genus 2.

Each function returns a ControlMesh: coarse, oriented outwards, closed.
"""

from dataclasses import dataclass, field
from itertools import pairwise, product

import numpy as np


@dataclass(frozen=True)
class ControlMesh:
    vertices: np.ndarray  # (n, 3) float64
    faces: list[tuple[int, ...]]  # counter-clockwise seen from outside
    crease_edges: list[tuple[int, int]] = field(default_factory=list)


class _Builder:
    """Collects vertices by name, so that faces are written by names."""

    def __init__(self):
        self.positions = []
        self.ids = {}
        self.faces = []
        self.creases = []

    def vertex(self, name, position):
        self.ids[name] = len(self.positions)
        self.positions.append(position)

    def face(self, *names):
        self.faces.append(tuple(self.ids[name] for name in names))

    def crease(self, *names):
        """A run of crease edges along the named vertices."""
        self.creases += [(self.ids[a], self.ids[b]) for a, b in pairwise(names)]

    def mesh(self):
        return ControlMesh(np.array(self.positions, float), self.faces, self.creases)


def faceted_sphere():
    """The rhombicuboctahedron on the unit sphere: 24 vertices, 18 squares and 8 triangles, so both kinds of faces meet."""
    builder = _Builder()
    tall = 1 + np.sqrt(2)
    for signs in product((-1, 1), repeat=3):
        for axis in range(3):  # vertex (axis, signs) lies on the square around that axis
            scale = np.where(np.arange(3) == axis, tall, 1) / np.sqrt(2 + tall**2)
            builder.vertex((axis, signs), np.array(signs) * scale)

    def square(axis, sign, points):
        """Four points around the outward direction `sign`·axis, given in the order (−,−) (+,−) (+,+) (−,+)."""
        builder.face(*(points if sign > 0 else points[::-1]))

    around = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        for sign in (-1, 1):
            square(axis, sign, [(axis, _signs(axis, sign, b, u, c, v)) for u, v in around])
        for s, t in around:  # the square over the edge between the squares around b and c
            run = [(b, -1), (c, -1), (c, 1), (b, 1)]
            points = [(owner, _signs(axis, u, b, s, c, t)) for owner, u in run]
            square(axis, s * t, points)
    for signs in product((-1, 1), repeat=3):
        corner = [(axis, signs) for axis in range(3)]
        builder.face(*(corner if np.prod(signs) > 0 else corner[::-1]))
    return builder.mesh()


def _signs(*pairs):
    """The triple with the given values at the given axes: _signs(axis, value, axis, value, …)."""
    signs = [0, 0, 0]
    for axis, value in zip(pairs[::2], pairs[1::2], strict=True):
        signs[axis] = value
    return tuple(signs)


def hull():
    """A hard-chine hull of 9 m with deck and transom, all quads; creases along keel and stem, chine, sheer and transom.

    x runs forward from the transom, y to port, z up from the lowest point of the keel. A section has five points a side:
    keel, half bottom, chine, half topside, sheer; the deck adds one between sheer and centre line. Near the chine the
    stem is straight, so its crease, which the chines cut in two there, runs through without a kink.
    """
    stations = np.array([0.0, 1.25, 2.6, 3.95, 5.2, 6.3, 7.2, 7.85])
    builder = _Builder()
    rows = range(len(stations))
    bow = len(stations)  # the row on the stem, where both sides meet
    for i, x in enumerate(stations):
        for j, (y, z) in enumerate(_section(x)):
            _place(builder, i, j, x - 0.12 * z * (x == 0.0), y, z)  # a raked transom
    for j, (x, z) in enumerate(
        ((8.25, 0.30), (8.42, 0.58), (8.58, 0.86), (8.79, 1.22), (9.02, 1.615))
    ):
        _place(builder, bow, j, x, 0.0, z)
    _transom_inside(builder)

    for side in (1, -1):
        for i, j in product((*rows,), range(6)):
            if i < bow - 1 or j < 4:
                _quad(builder, side, (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
        _quad(
            builder, side, (bow - 1, 4), (bow, 4), (bow - 1, 6), (bow - 1, 5)
        )  # the tip of the deck
        inside, middle = "inside", "middle"
        _quad(builder, side, (0, 0), (0, 1), inside, middle)
        _quad(builder, side, (0, 1), (0, 2), (0, 3), inside)
        _quad(builder, side, (0, 3), (0, 4), (0, 5), inside)
        _quad(builder, side, (0, 5), (0, 6), middle, inside)
        for line in (2, 4):  # chine and sheer
            builder.crease(*(_name((i, line), side) for i in range(bow + 1)))
        builder.crease(*(_name((0, j), side) for j in range(7)))
    builder.crease(
        *(_name((i, 0), 1) for i in range(bow + 1)), *(_name((bow, j), 1) for j in range(1, 5))
    )
    return builder.mesh()


def _section(x):
    """The seven points (y, z) of the section at x, from keel over chine and sheer to the middle of the deck."""
    t = x / 9.0
    forward = np.clip((t - 0.40) / 0.60, 0, 1)
    aft = np.clip((0.40 - t) / 0.40, 0, 1)
    keel = 0.02 + 0.06 * aft**2 + 0.20 * forward**5
    chine = (
        1.22 * (1 - forward**1.75) * (1 - 0.10 * aft**2),
        0.40 + 0.46 * forward**1.8 - 0.04 * aft,
    )
    sheer = (
        1.50 * (1 - forward**2.4) * (1 - 0.13 * aft**2),
        1.18 + 0.42 * forward**1.7 + 0.05 * aft**2,
    )
    bottom = (0.52 * chine[0], keel + 0.47 * (chine[1] - keel))
    flare = (
        0.5 - 0.16 * forward * (1 - forward) * 4 * 0.5 + 0.06 * (1 - forward)
    )  # hollow forward, round aft
    topside = (
        chine[0] + flare * (sheer[0] - chine[0]) + 0.03 * (1 - forward),
        0.5 * (chine[1] + sheer[1]),
    )
    crown = 0.075 * sheer[0]
    return (
        (0.0, keel),
        bottom,
        chine,
        topside,
        sheer,
        (0.52 * sheer[0], sheer[1] + 0.72 * crown),
        (0.0, sheer[1] + crown),
    )


def _transom_inside(builder):
    heel, deck = (np.array(builder.positions[builder.ids[(0, j)]]) for j in (0, 6))
    builder.vertex("middle", 0.45 * heel + 0.55 * deck)
    shoulder = np.array(builder.positions[builder.ids[(0, 3, 1)]])
    x, y, z = 0.5 * builder.positions[builder.ids["middle"]] + 0.5 * shoulder
    for side in (1, -1):
        builder.vertex(("inside", side), (x, side * y, z))


def _place(builder, i, j, x, y, z):
    """Point j of row i: once on the centre line, else on either side."""
    if y == 0.0:
        builder.vertex((i, j), (x, 0.0, z))
    else:
        for side in (1, -1):
            builder.vertex((i, j, side), (x, side * y, z))


def _name(point, side):
    """A point of the half hull as the builder knows it: those off the centre line have a side."""
    if point == "inside":
        return (point, side)
    if point == "middle" or point[0] == 8 or point[1] in (0, 6):
        return point
    return (*point, side)


def _quad(builder, side, *points):
    """A quad given for the port side, or its mirror image."""
    names = [_name(point, side) for point in points]
    builder.face(*(names if side < 0 else names[::-1]))


def branching():
    """Two hubs joined by three twisted arms, all quads: 64 vertices, 66 faces, genus 2."""
    builder = _Builder()
    for hub, height, turn in (("low", 0.0, 0.0), ("high", 3.0, TWIST)):
        _hub(builder, hub, height, turn)
    for arm in range(3):
        _arm(builder, arm)
    return builder.mesh()


TWIST = np.radians(80)
_ARM_RINGS = 3  # between the two hubs


def _hub(builder, hub, height, turn):
    """A hexagonal prism with its ends split into three quads; every other side is open, and there an arm begins."""
    outside, inside = ("bottom", "top") if hub == "low" else ("top", "bottom")
    for level, dz, radius in (("bottom", -0.24, 0.44), ("top", 0.24, 0.44)):
        for k in range(6):
            angle = turn + np.pi / 3 * k - np.pi / 6
            builder.vertex(
                (hub, level, k), (radius * np.cos(angle), radius * np.sin(angle), height + dz)
            )
    for level, dz in ((outside, 0.36), (inside, 0.20)):
        builder.vertex((hub, level, "centre"), (0, 0, height + (dz if level == "top" else -dz)))
    for k in (0, 2, 4):
        k1, k2, k3 = k + 1, (k + 2) % 6, (k + 3) % 6
        builder.face((hub, "bottom", k1), (hub, "bottom", k2), (hub, "top", k2), (hub, "top", k1))
        builder.face((hub, "top", "centre"), (hub, "top", k1), (hub, "top", k2), (hub, "top", k3))
        builder.face(
            (hub, "bottom", "centre"), (hub, "bottom", k3), (hub, "bottom", k2), (hub, "bottom", k1)
        )


def _arm(builder, arm):
    """Rings of four from the low hub's open side number `arm` out and up to the high hub's."""
    k = 2 * arm
    rings = [
        [("low", "bottom", k), ("low", "bottom", k + 1), ("low", "top", k + 1), ("low", "top", k)]
    ]
    for r in range(1, _ARM_RINGS + 1):
        t = r / (_ARM_RINGS + 1)
        turn = TWIST * t + 2 * np.pi / 3 * arm
        out, up = np.array([np.cos(turn), np.sin(turn), 0]), np.array([0, 0, 1])
        across = np.array([-np.sin(turn), np.cos(turn), 0])
        tilt = np.pi * (t - 0.5)  # the ring turns over from facing out to facing in
        rise = -np.sin(tilt) * out + np.cos(tilt) * (up * 0.92 + across * 0.39)
        lean = np.cos(tilt) * out + np.sin(tilt) * up
        side = np.cross(rise, lean)
        centre = (0.44 + 1.16 * np.sin(np.pi * t) ** 0.8) * out + (
            1.5 - 1.62 * np.cos(np.pi * t)
        ) * up
        ring = []
        for c, (s, w) in enumerate(((-1, 1), (1, 1), (1, -1), (-1, -1))):
            builder.vertex((arm, r, c), centre + 0.25 * (1.15 * s * side + 0.9 * w * lean))
            ring.append((arm, r, c))
        rings.append(ring)
    rings.append(
        [
            ("high", "top", k),
            ("high", "top", k + 1),
            ("high", "bottom", k + 1),
            ("high", "bottom", k),
        ]
    )
    for low, high in pairwise(rings):
        for c in range(4):
            d = (c + 1) % 4
            builder.face(low[c], low[d], high[d], high[c])


SHAPES = {"sphere": faceted_sphere, "hull": hull, "branching": branching}
