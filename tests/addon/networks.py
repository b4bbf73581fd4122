# SPDX-License-Identifier: GPL-3.0-or-later
"""Networks of curves: points to pass through, by name. Plain arrays, no Blender."""

import numpy as np

from addon.curves.cubics import Curve, through

TURN = 2 * np.pi


def drawn(name, way, start, end, count=9, closed=False):
    """The curve through `count` points of the function `way` of one number."""
    at = np.linspace(start, end, count, endpoint=not closed)
    return Curve(name, through(np.array([way(t) for t in at]), closed), closed)


def crown(x, y):
    """The height of a bonnet."""
    return 0.35 * (1 - 0.4 * x**2) * (1 - 0.25 * y**2)


def across(name, x, half=0.8):
    return drawn(name, lambda y: (x, y, crown(x, y)), -half, half)


def along(name, y, start=-1.0, end=1.0):
    return drawn(name, lambda x: (x, y, crown(x, y)), start, end)


def three_by_four():
    rows = [along(f"Row {k}", y) for k, y in enumerate((-0.8, 0.0, 0.8))]
    return rows + [across(f"Column {k}", x) for k, x in enumerate((-1.0, -0.35, 0.4, 1.0))]


def bonnet():
    """Five sections, of which the middle one is missing, and three curves along."""
    sections = [across(f"Section {k}", x) for k, x in ((1, -1), (2, -0.5), (4, 0.5), (5, 1))]
    return sections + [along(n, y) for n, y in (("Left", -0.8), ("Middle", 0), ("Right", 0.8))]


def hull():
    """Five frames from rail to rail, and the two rails."""

    def beam(x):
        return 0.75 * (1 - 0.45 * (0.6 * (x + 0.3)) ** 2) * (1 if x < 0 else 1 - 0.45 * x**2)

    def sheer(x):
        return 0.5 + 0.12 * x**2

    def frame(number, x):
        half, top, keel = beam(x), sheer(x), -0.45 + 0.2 * x**2
        bilge = [(-0.97, 0.58), (-0.66, 0.12), (0.0, 0.0), (0.66, 0.12), (0.97, 0.58)]
        points = [(x, y * half, keel + z * (top - keel)) for y, z in [(-1, 1), *bilge, (1, 1)]]
        return Curve(f"Frame {number}", through(np.array(points), False))

    frames = [frame(k, x) for k, x in enumerate((-1.0, -0.5, 0.0, 0.5, 1.0), 1)]
    rails = [
        drawn(name, lambda x, side=side: (x, side * beam(x), sheer(x)), -1.0, 1.0)
        for name, side in (("Port", -1), ("Starboard", 1))
    ]
    return frames + rails


def great_circles():
    ways = {
        "XY": lambda t: (np.cos(t), np.sin(t), 0.0),
        "XZ": lambda t: (np.cos(t), 0.0, np.sin(t)),
        "YZ": lambda t: (0.0, np.cos(t), np.sin(t)),
    }
    return [drawn(name, way, 0, TURN, 24, True) for name, way in ways.items()]


def tube():
    """Three rings, four lines along."""
    rings = [
        drawn(f"Ring {z}", lambda t, z=z: (np.cos(t), np.sin(t), z), 0, TURN, 16, True)
        for z in (-1, 0, 1)
    ]
    corners = [(np.cos(a), np.sin(a)) for a in np.arange(4) * TURN / 4]
    lines = [drawn(f"Line {k}", lambda z, c=c: (*c, z), -1, 1, 3) for k, c in enumerate(corners)]
    return rings + lines


def polygon(sides):
    """So many arcs around a middle, whose ends alternate between up and down."""

    def corner(k):
        a = TURN * (k % sides) / sides
        return np.array([np.cos(a), np.sin(a), 0.15 * np.cos(2 * a)])

    return [
        Curve(
            f"Side {k}",
            through(
                np.array([corner(k), (corner(k) + corner(k + 1)) / 2 + (0, 0, 0.1), corner(k + 1)]),
                False,
            ),
        )
        for k in range(sides)
    ]


def loop():
    """One closed curve."""
    return [drawn("Loop", lambda t: (np.cos(t), np.sin(t), 0.2 * np.cos(2 * t)), 0, TURN, 24, True)]
