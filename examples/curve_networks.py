# SPDX-License-Identifier: GPL-3.0-or-later
"""Networks of curves, each as (name, points, closed) to be passed: the shapes of docs/how-to/curves.md. Plain NumPy."""

import numpy as np

POINTS = 7  # of a row or a column


def crossing():
    """Three curves that cross four others."""
    rows = [_row(f"Row {k}", y, _wave) for k, y in enumerate((-0.8, 0.0, 0.8))]
    return rows + [_column(f"Column {k}", x, _wave) for k, x in enumerate((-1.2, -0.4, 0.4, 1.2))]


def bonnet():
    """Five sections, of which the third is missing, and three curves along."""
    stations = ((1, -1.2), (2, -0.6), (4, 0.6), (5, 1.2))
    sections = [_column(f"Section {k}", x, crown) for k, x in stations]
    return sections + [
        _row(name, y, crown) for name, y in (("Left", -0.8), ("Middle", 0.0), ("Right", 0.8))
    ]


def hull():
    """Five frames from rail to rail, and the two rails."""
    frames = []
    for k, x in enumerate(np.linspace(-1.5, 1.5, 5), 1):
        beam, sheer, keel = _beam(x), _sheer(x), -0.42 + 0.09 * x**2
        girth = [(-1, 1), (-0.97, 0.58), (-0.66, 0.12), (0, 0), (0.66, 0.12), (0.97, 0.58), (1, 1)]
        frames.append((f"Frame {k}", [(x, y * beam, keel + z * (sheer - keel)) for y, z in girth]))
    rails = [
        (name, [(x, side * _beam(x), _sheer(x)) for x in np.linspace(-1.5, 1.5, 9)])
        for name, side in (("Port", -1), ("Starboard", 1))
    ]
    return [(name, np.array(points), False) for name, points in frames + rails]


def star():
    """Five cells meet at a corner, around one cell of five sides."""
    turn = 2 * np.pi * np.arange(5) / 5
    outer = np.stack([1.3 * np.cos(turn), 1.3 * np.sin(turn), np.zeros(5)], axis=1)
    inner = np.stack([0.6 * np.cos(turn), 0.6 * np.sin(turn), np.full(5, 0.5)], axis=1)
    found = []
    for k in range(5):
        n = (k + 1) % 5
        rim = 1.12 * (outer[k] + outer[n]) / 2 + (0, 0, -0.05)
        ring = 1.05 * (inner[k] + inner[n]) / 2 + (0, 0, 0.06)
        spoke = (outer[k] + inner[k]) / 2 + (0, 0, 0.12)
        for name, a, m, b in (
            ("Rim", outer[k], rim, outer[n]),
            ("Ring", inner[k], ring, inner[n]),
            ("Spoke", outer[k], spoke, inner[k]),
        ):
            found.append((f"{name} {k}", np.array([a, m, b]), False))
    return found


def _row(name, y, height):
    x = np.linspace(-1.2, 1.2, POINTS)
    return name, np.stack([x, np.full(POINTS, y), height(x, y)], axis=1), False


def _column(name, x, height):
    y = np.linspace(-0.8, 0.8, POINTS)
    return name, np.stack([np.full(POINTS, x), y, height(x, y)], axis=1), False


def crown(x, y):
    return 0.4 * (1 - 0.32 * x**2) * (1 - 0.35 * y**2)


def _wave(x, y):
    return 0.22 * np.sin(1.6 * x) + 0.25 * (1 - y**2)


def _beam(x):
    return 0.72 * (1 - 0.16 * (x + 0.3) ** 2) * (1 - 0.12 * np.maximum(x, 0) ** 2)


def _sheer(x):
    return 0.45 + 0.06 * x**2
