# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes that are hard to fair."""

import numpy as np


def lathe(profile, around):
    """A closed body of revolution through the points (radius, height) of its profile."""
    turn = 2.0 * np.pi * np.arange(around) / around
    points = [(r * np.cos(t), r * np.sin(t), z) for r, z in profile for t in turn]
    following = np.roll(np.arange(around), -1)
    rings = [around * k for k in range(len(profile))]
    faces = [
        (low + i, low + following[i], high + following[i], high + i)
        for low, high in zip(rings, rings[1:])
        for i in range(around)
    ]
    bottom, top = range(around - 1, -1, -1), range(rings[-1], rings[-1] + around)
    return points, [tuple(map(int, f)) for f in [*faces, bottom, top]]


def mug(wall, around=8):
    """A cup with thin walls: under a strong energy the inner one breaks through the outer one."""
    inner = 1.0 - wall
    return lathe([(1, 0), (1, 1), (1, 2), (inner, 2), (inner, 1), (inner, wall)], around)
