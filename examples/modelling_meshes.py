# SPDX-License-Identifier: GPL-3.0-or-later
"""A fender and a mug as modellers block them out by hand, in plain NumPy."""

import numpy as np
from demo_meshes import ControlMesh

ARCH = 9  # columns of the fender, from the front to the rear of the wheel
AROUND = 12  # sides of the mug


def fender():
    """A flared fender: rows from the lip of the wheel arch over the flare and the shoulder to the bonnet."""
    angles = np.linspace(np.pi, 0.0, ARCH)
    c, s = np.cos(angles), np.sin(angles)
    square = (np.abs(c) ** 3 + np.abs(s) ** 3) ** (-1 / 3)  # the outline of the panel
    rows = (
        (0.62 * c, np.full(ARCH, 0.90), 0.62 * s),
        (0.64 * c, np.full(ARCH, 1.02), 0.64 * s),
        (0.78 * c, np.full(ARCH, 0.98), 0.78 * s),
        (1.25 * square * c, np.full(ARCH, 0.90), 1.02 * square * s),
        (1.30 * square * c, np.full(ARCH, 0.72), 1.16 * square * s),
        (1.30 * square * c, np.full(ARCH, 0.30), 1.22 * square * s),
    )
    points = np.stack([np.stack(row, axis=1) for row in rows]).reshape(-1, 3)
    faces = [
        (j * ARCH + i, j * ARCH + i + 1, (j + 1) * ARCH + i + 1, (j + 1) * ARCH + i)
        for j in range(len(rows) - 1)
        for i in range(ARCH - 1)
    ]
    return ControlMesh(points * [1, -1, 1], faces)


def mug():
    """A mug with a wall, a bottom and a handle of six quads each way round."""
    outer = ((0.55, 0.0), (0.96, 0.0), (1.0, 0.12), (1.0, 0.5), (1.0, 0.85), (1.0, 1.3))
    outer += ((1.0, 1.65), (1.0, 2.0))
    inner = ((0.88, 2.0), (0.88, 1.3), (0.88, 0.5), (0.85, 0.2), (0.5, 0.16))
    turn = 2 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
    rings = [
        np.stack([r * np.cos(turn), r * np.sin(turn), np.full(AROUND, z)], axis=1)
        for r, z in (*outer, *inner)
    ]
    points = [*np.concatenate(rings), np.array([0, 0, 0.0]), np.array([0, 0, 0.16])]
    below, above = len(points) - 2, len(points) - 1
    last = AROUND - 1  # the side towards x, where the handle is
    holes = {(3, last), (5, last)}
    faces = []
    for ring in range(len(rings) - 1):
        for i in range(AROUND):
            if (ring, i) not in holes:
                k, low, high = (i + 1) % AROUND, ring * AROUND, (ring + 1) * AROUND
                faces.append((low + i, low + k, high + k, high + i))
    top = (len(rings) - 1) * AROUND
    for i in range(AROUND):
        k = (i + 1) % AROUND
        faces += [(k, i, below), (top + i, top + k, above)]
    _handle(points, faces, last)
    return ControlMesh(np.array(points), faces)


def _handle(points, faces, side):
    """A bent bar from the lower hole to the upper one."""

    def hole(ring):
        low, high, k = ring * AROUND, (ring + 1) * AROUND, (side + 1) % AROUND
        return [low + side, low + k, high + k, high + side]

    middles = ((1.35, 0.62, 70), (1.62, 0.85, 30), (1.66, 1.2, -10), (1.4, 1.47, -60))
    loop = hole(3)
    for x, z, lean in middles:
        across = np.radians(lean)
        begin = len(points)
        for y, out in ((-0.13, 1), (0.13, 1), (0.13, -1), (-0.13, -1)):
            points.append(
                np.array([x + 0.11 * out * np.sin(across), y, z - 0.11 * out * np.cos(across)])
            )
        _tube(faces, loop, [begin + i for i in range(4)])
        loop = [begin + i for i in range(4)]
    upper = hole(5)
    _tube(faces, loop, [upper[3], upper[2], upper[1], upper[0]])


def _tube(faces, loop, following):
    for i in range(4):
        k = (i + 1) % 4
        faces.append((loop[i], loop[k], following[k], following[i]))
