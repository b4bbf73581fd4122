# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts with large flat faces between tight rims: (vertices (n, 3), faces, flat faces, side faces). Flat faces lie
in planes, side faces on a cylinder about z; both are ids. Lengths in millimetres."""

import numpy as np


def rounded_box(length, width, height, radius):
    """Six flat faces, rims in two chords of 45 degrees, corners in three quads."""
    half = np.array([length, width, height]) / 2 - radius
    index, points, faces, flat = {}, [], [], []
    sign, tilt = np.array([-1, -1, 1, 1]), np.array([1, 0, 0, 1])
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1, 1):
            ids = np.empty((4, 4), int)
            for i in range(4):
                for j in range(4):
                    away, inner = np.zeros(3), np.zeros(3)
                    away[[u, v, axis]] = sign[i] * tilt[i], sign[j] * tilt[j], side
                    inner[[u, v, axis]] = sign[i], sign[j], side
                    at = inner * half + radius * away / np.linalg.norm(away)
                    key = tuple(np.round(at, 9))
                    if key not in index:
                        index[key] = len(points)
                        points.append(at)
                    ids[i, j] = index[key]
            for i in range(3):
                for j in range(3):
                    quad = [ids[i, j], ids[i + 1, j], ids[i + 1, j + 1], ids[i, j + 1]]
                    if i == j == 1:
                        flat.append(len(faces))
                    faces.append(quad if side > 0 else quad[::-1])
    return np.array(points), faces, flat, []


def turned(profile, sides=12):
    """A profile [(radius, z, kind of the band to the next)] about z, from its axis to its axis: the first and the last
    have radius 0, and their bands are discs of triangles. Kinds: "flat", "side" or ""."""
    rings = len(profile) - 2
    angle = 2 * np.pi * np.arange(sides) / sides
    points = [(0.0, 0.0, profile[0][1])]
    for radius, z, _ in profile[1:-1]:
        points += [(radius * np.cos(a), radius * np.sin(a), z) for a in angle]
    points.append((0.0, 0.0, profile[-1][1]))
    faces, kind = [], []
    for band, (_, _, what) in enumerate(profile[:-1]):
        for k in range(sides):
            nxt = (k + 1) % sides
            low, high = 1 + (band - 1) * sides, 1 + band * sides
            if band == 0:
                face = [0, high + nxt, high + k]
            elif band == rings:
                face = [low + k, low + nxt, len(points) - 1]
            else:
                face = [low + k, low + nxt, high + nxt, high + k]
            faces.append(face)
            kind.append(what)
    chosen = [[f for f, what in enumerate(kind) if what == wanted] for wanted in ("flat", "side")]
    return np.array(points), faces, *chosen


def rim(radius, z, size, start, turn=np.pi / 2):
    """Two chords of an arc about (radius, z) in the half plane, from the angle `start` on: three points."""
    return [
        (radius + size * np.cos(a), z + size * np.sin(a))
        for a in start + turn * np.array([0, 0.5, 1])
    ]


def can(radius, height, size=2.0):
    """Flat ends, a side on a cylinder, rims of `size`."""
    low = rim(radius - size, size, size, -np.pi / 2)
    high = rim(radius - size, height - size, size, 0.0)
    kinds = ["", "", "side", "", "", "flat"]
    ring = [(*p, kind) for p, kind in zip(low + high, kinds)]
    return turned([(0, 0.0, "flat"), *ring, (0, height, "")])


def stacked(outlines):
    """Outlines (k, 3) of equally many vertices, one above the other, closed by their first and last one."""
    count = len(outlines[0])
    rows = np.arange(count * len(outlines)).reshape(-1, count)
    faces = [rows[0, ::-1].tolist(), rows[-1].tolist()]
    for low, high in zip(rows, rows[1:]):
        ring = np.stack([low, np.roll(low, -1), np.roll(high, -1), high], axis=1)
        faces += ring.tolist()
    return np.concatenate(outlines), faces


def rounded_outline(length, width, radius, z, chords=4):
    angle = np.linspace(0, np.pi / 2, chords + 1) + np.pi / 2 * np.arange(4)[:, None]
    middle = np.array([length, width]) / 2 - radius
    corner = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])[:, None] * middle
    arc = corner + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return np.concatenate([arc, np.full((4, chords + 1, 1), z)], axis=-1).reshape(-1, 3)


def chamfered_cylinder(sides, fans=""):
    """(vertices, faces): radius 12.5, height 50, chamfers of 1.5; the wall is one face high, its faces the first ones.

    With `fans` all faces are triangles, those of the caps about a vertex of their "rims", or about their "middles"."""
    profile = [(12.5, 1.5), (12.5, 48.5), (11.0, 50.0), (11.0, 0.0)]
    angle = 2 * np.pi * np.arange(sides) / sides
    points = [(r * np.cos(a), r * np.sin(a), z) for r, z in profile for a in angle]
    ring = np.stack([np.arange(sides), (np.arange(sides) + 1) % sides], axis=1)
    bands = [sides * np.array([low, high]) for low, high in ((0, 1), (1, 2), (3, 0))]
    quads = np.concatenate([np.hstack([ring + low, ring[:, ::-1] + high]) for low, high in bands])
    if not fans:
        caps = [ring[:, 0] + 2 * sides, ring[::-1, 0] + 3 * sides]
        return np.array(points), [*quads.tolist(), *map(np.ndarray.tolist, caps)]
    apex = [2 * sides, 3 * sides] if fans == "rims" else [4 * sides, 4 * sides + 1]
    ring = ring[1:-1] if fans == "rims" else ring
    caps = [np.insert(ring + (2 + k) * sides, 0, apex[k], axis=1) for k in (0, 1)]
    points += [(0.0, 0.0, 50.0), (0.0, 0.0, 0.0)] if fans == "middles" else []
    return np.array(points), np.concatenate(
        [quads[:, :3], quads[:, [0, 2, 3]], caps[0], caps[1][:, ::-1]]
    )


PARTS = {
    "phone shell": (rounded_box, [(140, 70, 9, 3), (120, 70, 7, 2), (160, 75, 12, 4)]),
    "remote control": (rounded_box, [(160, 40, 18, 4), (200, 45, 15, 3), (120, 40, 22, 5)]),
    "soap box": (rounded_box, [(90, 60, 30, 4), (100, 50, 20, 3), (80, 70, 40, 6)]),
    "can": (can, [(33, 120), (40, 50), (50, 20)]),
}
