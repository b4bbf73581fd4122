# SPDX-License-Identifier: GPL-3.0-or-later
"""Assigns faces to pieces: the mesh is cut across its longest side, and the parts again."""

import numpy as np


def partition(centres: np.ndarray, weights: np.ndarray, count: int) -> np.ndarray:
    """(m,) int32: the piece of each face, from 0 to count - 1, numbered by their first faces.

    centres: (m, 3), of the faces; weights: (m,), the number of refined faces of each; count: at most m.
    Each piece has at least one face, and all about the same weight.
    """
    labels = np.zeros(len(centres), np.int64)
    parts = [(np.arange(len(centres)), count)]
    found = 0
    while parts:
        faces, pieces = parts.pop()
        if pieces == 1:
            labels[faces] = found
            found += 1
            continue
        axis = int(np.argmax(np.ptp(centres[faces], axis=0)))
        faces = faces[np.argsort(centres[faces, axis], kind="stable")]
        before = np.cumsum(weights[faces])
        here = pieces // 2
        share = np.searchsorted(before, before[-1] * here / pieces)
        cut = int(np.clip(share, here, len(faces) - (pieces - here)))
        parts += [(faces[cut:], pieces - here), (faces[:cut], here)]
    _, first, place = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[place]
