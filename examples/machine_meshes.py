# SPDX-License-Identifier: GPL-3.0-or-later
"""Machine parts as coarse cages, whose surfaces are known: turned, extruded and bent.

Each function returns vertices, faces, and a function that gives the distance of points (n, 3) from the
part's surface.
"""

from itertools import pairwise

import numpy as np

SIDES = 16  # of what is turned: its wall has angles of 22.5°, which are no folds


def _arc(centre, radius, begin, end, count):
    angles = np.radians(np.linspace(begin, end, count))
    return [(centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)) for a in angles]


def _from_segments(points, outline):
    """Distances of points (n, 2) from a polyline."""
    nearest = np.full(len(points), np.inf)
    for a, b in pairwise(np.array(outline, float)):
        way = b - a
        t = np.clip((points - a) @ way / (way @ way), 0, 1)
        nearest = np.minimum(nearest, np.linalg.norm(points - a - t[:, None] * way, axis=1))
    return nearest


def _turned(profile, truth=None):
    """A body about z through (r, z), from the lower pole to the upper one."""
    turn = 2 * np.pi * np.arange(SIDES) / SIDES
    vertices = [[(r * np.cos(a), r * np.sin(a), z) for a in turn] for r, z in profile[1:-1]]
    vertices = [*np.reshape(vertices, (-1, 3)), (0, 0, profile[0][1]), (0, 0, profile[-1][1])]
    last = (len(profile) - 3) * SIDES
    faces = []
    for k in range(SIDES):
        j = (k + 1) % SIDES
        faces += [(j, k, len(vertices) - 2), (last + k, last + j, len(vertices) - 1)]
        for row in range(0, last, SIDES):
            faces.append((row + k, row + j, row + SIDES + j, row + SIDES + k))

    def off(points):
        flat = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
        return _from_segments(flat, truth or profile)

    return np.array(vertices, float), faces, off


def _extruded(outline, truth=None, columns=4, depth=1.6):
    """A closed outline (x, z) along y, open at both ends."""
    count = len(outline)
    vertices = [(x, y, z) for y in np.linspace(0, depth, columns) for x, z in outline]
    faces = []
    for row in range(columns - 1):
        for k in range(count):
            j, low, high = (k + 1) % count, row * count, (row + 1) * count
            faces.append((low + k, high + k, high + j, low + j))
    closed = truth or outline
    return np.array(vertices), faces, lambda p: _from_segments(p[:, [0, 2]], [*closed, closed[0]])


def drum():
    """A cylinder with flat ends."""
    return _turned([(0, 0), (0.5, 0), (1, 0), (1, 0.8), (1, 1.6), (0.5, 1.6), (0, 1.6)])


def knob():
    """A stem, a flange, and a dome on it."""
    stem = [(0, 0), (0.3, 0), (0.55, 0), (0.55, 0.25), (0.55, 0.5), (0.8, 0.5)]
    dome = ((0, -0.25), 1.25, np.degrees(np.arcsin(0.6)), 90)
    return _turned([*stem, *_arc(*dome, 6)], [*stem, *_arc(*dome, 400)])


def nozzle():
    """A cone between two cylinders."""
    return _turned(
        [(0, 0), (0.2, 0), (0.35, 0), (0.35, 0.3), (0.35, 0.6), (0.7, 0.95), (1.05, 1.3)]
        + [(1.05, 1.6), (1.05, 1.9), (0.6, 1.9), (0, 1.9)]
    )


def pulley():
    """A wheel with a groove that is half a circle."""
    groove = ((1.0, 0.5), 0.3, 270, 90)
    side, other = [(0, 0), (0.5, 0), (1, 0)], [(1, 1), (0.5, 1), (0, 1)]
    return _turned([*side, *_arc(*groove, 9), *other], [*side, *_arc(*groove, 400), *other])


def ball_joint():
    """Most of a ball on a stem."""
    stem = [(0, -1.6), (0.25, -1.6), (0.5, -1.6), (0.5, -1.25)]
    ball = ((0, 0), 1, -60, 90)
    return _turned([*stem, *_arc(*ball, 8)], [*stem, *_arc(*ball, 400)])


def bevelled_bar():
    """A bar with bevels of 45°."""
    return _extruded(
        [(0.2, 0), (0.7, 0), (1.2, 0), (1.4, 0.2), (1.4, 0.8), (1.2, 1), (0.7, 1), (0.2, 1)]
        + [(0, 0.8), (0, 0.2)]
    )


def bracket():
    """An angle bracket with a fillet inside."""
    fillet = ((0.7, 0.7), 0.4, 270, 180)
    outer = [(0.3, 1.5), (0, 1.5), (0, 0.75), (0, 0), (0.75, 0), (1.5, 0), (1.5, 0.3)]
    return _extruded([*outer, *_arc(*fillet, 6)], [*outer, *_arc(*fillet, 400)])


def elbow():
    """A pipe that bends by a right angle, open at its ends."""
    turn, around = np.radians(np.linspace(0, 90, 6)), 2 * np.pi * np.arange(12) / 12
    tube = [(1.5 + 0.5 * np.cos(b), 0.5 * np.sin(b)) for b in around]
    vertices = [(r * np.cos(a), r * np.sin(a), z) for a in turn for r, z in tube]
    faces = []
    for row in range(0, 60, 12):
        for k in range(12):
            j = (k + 1) % 12
            faces.append((row + k, row + 12 + k, row + 12 + j, row + j))
    return (
        np.array(vertices),
        faces,
        lambda p: np.abs(np.hypot(np.hypot(p[:, 0], p[:, 1]) - 1.5, p[:, 2]) - 0.5),
    )


PARTS = {
    "drum": drum,
    "knob": knob,
    "nozzle": nozzle,
    "pulley": pulley,
    "ball joint": ball_joint,
    "bevelled bar": bevelled_bar,
    "bracket with a fillet": bracket,
    "pipe elbow": elbow,
}
