# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels and half hulls as coarse cages that a modeller draws: rows of points, to two or three digits.

Each function returns a Sheet. Lines run along x (fore and aft), rows across.
"""

from dataclasses import dataclass, field

import modelling_meshes
import numpy as np


@dataclass(frozen=True)
class Sheet:
    """A grid of control vertices, (rows, columns, 3), and the rows that are creases."""

    points: np.ndarray
    creases: tuple[int, ...] = field(default=())

    @property
    def vertices(self):
        return self.points.reshape(-1, 3)

    @property
    def faces(self):
        rows, columns = self.points.shape[:2]
        first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
        return np.stack([first, first + columns, first + columns + 1, first + 1], axis=1).tolist()

    @property
    def crease_edges(self):
        columns = self.points.shape[1]
        return [
            (r * columns + c, r * columns + c + 1) for r in self.creases for c in range(columns - 1)
        ]

    @property
    def corners(self):
        rows, columns = self.points.shape[:2]
        return [0, columns - 1, (rows - 1) * columns, rows * columns - 1]


def _sheet(along, rows, creases=()):
    """`rows`: y and z of each, numbers or one a column."""
    x = np.array(along, float)
    points = [
        np.stack([x, np.broadcast_to(y, x.shape), np.broadcast_to(z, x.shape)], axis=1)
        for y, z in rows
    ]
    return Sheet(np.stack(points).astype(float), creases)


def _lofted(stations, creases=()):
    """`stations`: x, and the points (y, z) of each from the keel or sill up."""
    points = [
        [(x + (p[2] if len(p) > 2 else 0), p[0], p[1]) for p in section] for x, section in stations
    ]
    return Sheet(np.array(points, float).swapaxes(0, 1), creases)


# --- panels ---------------------------------------------------------------------------------------


def bonnet():
    """A bonnet with a power bulge in the middle, whose flanks turn within one row."""
    x = (0.0, 0.3, 0.6, 0.9, 1.2)
    crown = np.array([0.0, 0.10, 0.16, 0.19, 0.20])
    bulge = np.array([0.02, 0.05, 0.06, 0.06, 0.05])
    rows = [(y, crown - drop + share * bulge) for y, drop, share in (
        (-0.70, 0.09, 0), (-0.45, 0.035, 0), (-0.28, 0.015, 0.0), (-0.20, 0.008, 0.9),
        (0.0, 0.0, 1.0),
        (0.20, 0.008, 0.9), (0.28, 0.015, 0.0), (0.45, 0.035, 0), (0.70, 0.09, 0))]  # fmt: skip
    return _sheet(x, rows)


def door():
    """A door with a creased character line over the handles, and a tuck at the sill."""
    x = (0.0, 0.25, 0.55, 0.85, 1.1)
    bow = np.array([0.0, 0.012, 0.018, 0.014, 0.004])
    rows = [(y + bow, z) for y, z in (
        (0.02, 0.0), (0.09, 0.08), (0.115, 0.25), (0.12, 0.42), (0.13, 0.58), (0.10, 0.64), (0.06, 0.78))]  # fmt: skip
    return _sheet(x, rows, creases=(4,))


def roof():
    """A crown that falls to a flange at either side within one row."""
    x = (0.0, 0.4, 0.8, 1.2, 1.6)
    crown = np.array([0.0, 0.07, 0.10, 0.09, 0.02])
    rows = [(y, share * crown - drop) for y, share, drop in (
        (-0.62, 0.9, 0.13), (-0.58, 0.9, 0.12), (-0.53, 0.95, 0.045), (-0.3, 1, 0.015), (0.0, 1, 0.0),
        (0.3, 1, 0.015), (0.53, 0.95, 0.045), (0.58, 0.9, 0.12), (0.62, 0.9, 0.13))]  # fmt: skip
    return _sheet(x, rows)


def fender():
    """The flared fender of the other pictures."""
    mesh = modelling_meshes.fender()
    return Sheet(mesh.vertices.reshape(-1, modelling_meshes.ARCH, 3))


def mirror():
    """The shell of a door mirror: a deep bowl with a tight lip."""
    turn = np.radians(np.linspace(-80, 80, 7))
    rows = []
    for reach, width, height in (
        (0.0, 0.10, 0.075), (0.02, 0.11, 0.083), (0.07, 0.108, 0.08), (0.11, 0.09, 0.062), (0.13, 0.055, 0.035)):  # fmt: skip
        rows.append(
            np.stack(
                [width * np.sin(turn), reach * (1 + 0.1 * np.cos(turn)), height * np.cos(turn)], 1
            )
        )
    return Sheet(np.round(np.stack(rows), 3))


def tailgate():
    """A spoiler lip over a concave number-plate recess."""
    x = (-0.55, -0.35, -0.12, 0.12, 0.35, 0.55)
    bow = np.array([0.0, 0.04, 0.055, 0.055, 0.04, 0.0])
    recess = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0])
    rows = [(y + bow - depth * recess, z) for y, depth, z in (
        (0.0, 0, 0.0), (0.03, 0, 0.12), (0.035, 0.03, 0.2), (0.03, 0.03, 0.32), (0.02, 0, 0.4),
        (0.03, 0, 0.52), (0.07, 0, 0.57), (0.02, 0, 0.60))]  # fmt: skip
    return _sheet(x, rows)


# --- half hulls, from keel to sheer -----------------------------------------------------------------


def tumblehome():
    """Round bilge, topsides that fall inwards amidships and flare forward."""
    return _lofted([
        (0.0, [(0.0, 0.55), (0.45, 0.60), (0.80, 0.78), (0.92, 1.05), (0.90, 1.35)]),
        (1.5, [(0.0, 0.20), (0.65, 0.30), (1.08, 0.60), (1.15, 1.00), (1.07, 1.32)]),
        (3.0, [(0.0, 0.05), (0.68, 0.20), (1.20, 0.55), (1.27, 1.00), (1.17, 1.34)]),
        (4.5, [(0.0, 0.02), (0.55, 0.22), (1.05, 0.58), (1.18, 1.02), (1.13, 1.42)]),
        (6.0, [(0.0, 0.10), (0.30, 0.32), (0.62, 0.65), (0.82, 1.08), (0.90, 1.55)]),
        (7.2, [(0.0, 0.35), (0.08, 0.52), (0.20, 0.80), (0.34, 1.20), (0.48, 1.70)]),
    ])  # fmt: skip


def hard_chine():
    """A dory: two flats with a creased chine, more rocker forward."""
    return _lofted([
        (0.0, [(0.0, 0.12), (0.25, 0.16), (0.48, 0.20), (0.56, 0.42), (0.63, 0.64)]),
        (1.0, [(0.0, 0.02), (0.31, 0.05), (0.60, 0.09), (0.72, 0.35), (0.83, 0.60)]),
        (2.0, [(0.0, 0.00), (0.33, 0.04), (0.64, 0.08), (0.78, 0.35), (0.90, 0.61)]),
        (3.0, [(0.0, 0.03), (0.27, 0.08), (0.52, 0.14), (0.68, 0.42), (0.82, 0.68)]),
        (4.0, [(0.0, 0.14), (0.13, 0.21), (0.25, 0.29), (0.38, 0.56), (0.50, 0.82)]),
        (4.6, [(0.0, 0.30), (0.05, 0.36), (0.10, 0.43), (0.16, 0.68), (0.22, 0.93)]),
    ], creases=(2,))  # fmt: skip


def planing():
    """A deep vee with a creased chine and a flat beside it, constant aft."""
    aft = [(0.0, 0.0), (0.5, 0.20), (0.95, 0.38), (1.08, 0.38), (1.16, 0.65), (1.20, 0.95)]
    return _lofted([
        (0.0, aft), (1.4, aft),
        (2.8, [(0.0, 0.01), (0.5, 0.23), (0.92, 0.42), (1.06, 0.43), (1.17, 0.72), (1.24, 1.02)]),
        (4.2, [(0.0, 0.06), (0.40, 0.34), (0.75, 0.58), (0.88, 0.61), (1.05, 0.90), (1.18, 1.18)]),
        (5.4, [(0.0, 0.25), (0.22, 0.55), (0.42, 0.83), (0.52, 0.88), (0.74, 1.13), (0.92, 1.36)]),
        (6.2, [(0.0, 0.60), (0.06, 0.82), (0.13, 1.05), (0.18, 1.11), (0.32, 1.32), (0.46, 1.50)]),
    ], creases=(2, 3))  # fmt: skip


def kayak():
    """Long, fine ends, shallow arch bottom."""
    beam = (0.03, 0.13, 0.22, 0.27, 0.28, 0.24, 0.14, 0.03)
    keel = (0.16, 0.04, 0.01, 0.0, 0.0, 0.01, 0.05, 0.20)
    sheer = (0.34, 0.27, 0.24, 0.23, 0.23, 0.24, 0.29, 0.40)
    stations = []
    for x, b, k, s in zip((0, 0.7, 1.5, 2.3, 3.1, 3.9, 4.7, 5.4), beam, keel, sheer, strict=True):
        section = ((0, 0), (0.55, 0.08), (0.88, 0.3), (1.0, 0.65), (0.97, 1.0))
        stations.append((x, [(round(b * y, 3), round(k + (s - k) * z, 3)) for y, z in section]))
    return _lofted(stations)


def bulb_bow():
    """The fore body of a ship: a bulb under a fine entrance that flares to the deck."""
    return _lofted([
        (0.0, [(0.0, 0.0), (1.6, 0.1), (2.3, 0.8), (2.4, 2.0), (2.42, 3.2), (2.45, 4.5)]),
        (2.5, [(0.0, 0.0), (1.3, 0.12), (1.95, 0.8), (2.0, 2.0), (2.1, 3.2), (2.35, 4.6)]),
        (5.0, [(0.0, 0.0), (0.85, 0.18), (1.3, 0.85), (1.25, 2.0), (1.5, 3.2), (2.1, 4.8)]),
        (7.0, [(0.0, 0.1), (0.55, 0.3), (0.8, 0.95), (0.6, 1.9), (0.85, 3.2), (1.65, 5.0)]),
        (8.5, [(0.0, 0.3), (0.42, 0.5), (0.55, 1.0), (0.22, 1.8), (0.35, 3.2), (1.1, 5.2)]),
        (9.6, [(0.0, 0.6), (0.28, 0.75), (0.34, 1.05), (0.05, 1.7, -0.5), (0.08, 3.2, -0.3), (0.55, 5.4)]),
    ])  # fmt: skip


def clipper():
    """Hollow waterlines forward, a flared bow over them."""
    return _lofted([
        (0.0, [(0.0, 0.0), (0.9, 0.12), (1.35, 0.55), (1.42, 1.1), (1.40, 1.7)]),
        (1.6, [(0.0, 0.0), (0.78, 0.15), (1.25, 0.6), (1.38, 1.15), (1.40, 1.75)]),
        (3.2, [(0.0, 0.0), (0.50, 0.20), (0.92, 0.65), (1.18, 1.2), (1.32, 1.85)]),
        (4.6, [(0.0, 0.02), (0.22, 0.25), (0.46, 0.7), (0.78, 1.28), (1.10, 2.0)]),
        (5.8, [(0.0, 0.1), (0.08, 0.32), (0.17, 0.75), (0.38, 1.35), (0.75, 2.15)]),
        (6.8, [(0.0, 0.4, 0), (0.02, 0.6), (0.05, 0.95), (0.13, 1.5), (0.38, 2.3)]),
    ])  # fmt: skip


PANELS = {"bonnet with a power bulge": bonnet, "door with a character line": door, "roof with flanges": roof,
          "flared fender": fender, "mirror shell": mirror, "tailgate with a recess": tailgate}  # fmt: skip
HULLS = {"tumblehome": tumblehome, "hard chine": hard_chine, "planing": planing, "kayak": kayak,
         "bulb bow": bulb_bow, "clipper bow": clipper}  # fmt: skip
