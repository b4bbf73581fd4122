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


def fish():
    """A body of eight sides with a thin fin on its back, raked backwards."""
    rings = (
        (-1, 0.03, 0.1),
        (-0.3, 0.2, 0.34),
        (0.1, 0.24, 0.4),
        (0.5, 0.2, 0.33),
        (0.95, 0.06, 0.09),
    )
    turn = np.pi / 4 * np.arange(8)
    points = [(x, y * c, z * s) for x, y, z in rings for c, s in zip(np.cos(turn), np.sin(turn))]
    foot = [9, 10, 11, 19, 27, 26, 25, 17]
    fin = {v: len(points) + k for k, v in enumerate(foot)} | {18: 18}
    raised = {v: (points[v][0] - 0.12, 0.08 * points[v][1], points[v][2] + 0.3) for v in fin}
    points[18] = raised.pop(18)
    points += raised.values()
    faces = [
        (8 * r + k, 8 * r + (k + 1) % 8, 8 * r + 8 + (k + 1) % 8, 8 * r + 8 + k)
        for r in range(4)
        for k in range(8)
    ]
    back = [face for face in faces if set(face) <= fin.keys()]
    faces = [face for face in faces if face not in back]
    faces += [tuple(fin[v] for v in face) for face in back]
    faces += [(a, b, fin[b], fin[a]) for a, b in zip(foot, foot[1:] + foot[:1])]
    faces += [(7 - k, 6 - k, 1 + k, k) for k in range(3)]
    faces += [(32 + k, 33 + k, 38 - k, 39 - k) for k in range(3)]
    return points, faces
