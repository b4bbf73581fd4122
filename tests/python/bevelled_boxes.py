# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes with bevelled edges, long faces beside edges a hundredth; surfaces must not swell."""

from itertools import product

import numpy as np


def bevelled_box(sides, bevel: float):
    """Vertices (24, 3), 26 faces; `bevel`: from the end of a side's face to the box's edge."""
    half = np.asarray(sides, float) / 2
    if not 0 < bevel < half.min():
        raise ValueError("The bevel has to leave something of every side.")
    points, number = [], {}
    for corner in product((-1, 1), repeat=3):
        for axis in range(3):  # on the side across this axis
            number[corner, axis] = len(points)
            points.append(np.array(corner) * np.where(np.arange(3) == axis, half, half - bevel))
    faces = []
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        for sign in (-1, 1):
            side = []
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = dict(zip((axis, *others), (sign, a, b)))
                side.append(number[tuple(corner[k] for k in range(3)), axis])
            faces.append(side)
    for axis in range(3):  # along which the edge runs
        one, two = (k for k in range(3) if k != axis)
        for signs in product((-1, 1), repeat=2):
            ends = []
            for along in (-1, 1):
                corner = dict(zip((axis, one, two), (along, *signs)))
                ends.append(tuple(corner[k] for k in range(3)))
            faces.append([number[ends[0], one], number[ends[1], one]])
            faces[-1] += [number[ends[1], two], number[ends[0], two]]
    faces += [[number[corner, axis] for axis in range(3)] for corner in product((-1, 1), repeat=3)]
    points = np.array(points)
    return points, [outwards(points, face) for face in faces]


def outwards(points: np.ndarray, face: list[int]) -> list[int]:
    """The face of a convex mesh around the origin, counter-clockwise from outside."""
    a, b, c = points[face[:3]]
    return face if np.cross(b - a, c - a) @ points[face].mean(0) > 0 else face[::-1]
