# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a boat, and both halves joined by hand."""

import numpy as np
from lattices import lattice_faces

COUNT = 7  # of frames


def hull(jitter=0.0):
    """Half a boat: rows of vertices from the keel, in the plane y = 0, up to the deck."""
    along, up = np.meshgrid(np.linspace(-3, 3, COUNT), np.linspace(0, 1, 4), indexing="ij")
    beam = (1 - (along / 3.5) ** 2) * np.sin(up * 1.4)
    points = np.stack([along, beam, up + 0.1 * along**2 / 9], axis=-1).reshape(-1, 3)
    points[points[:, 1] < 1e-12, 1] = jitter
    return points, lattice_faces(COUNT, 4)[:, [0, 3, 2, 1]]


def whole(points, faces):
    """Both halves, joined at the keel by hand."""
    keel = np.flatnonzero(points[:, 1] == 0)
    image = np.arange(len(points)) + len(points)
    image[keel] = keel
    others = np.setdiff1d(np.arange(len(points)), keel)
    image[others] = len(points) + np.arange(len(others))
    both = np.concatenate([points, points[others] * [1, -1, 1]])
    return both, np.concatenate([faces, image[faces[:, ::-1]]])
