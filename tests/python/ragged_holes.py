# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes such as scans have: faces that hang together, taken away at random."""

import numpy as np


def largest_piece(faces):
    """(m,) bool: faces of the largest piece that hangs together by edges."""
    owner = {}
    label = np.arange(len(faces))

    def root(k):
        while label[k] != k:
            label[k] = label[label[k]]
            k = label[k]
        return k

    for k, t in enumerate(faces.tolist()):
        for a, b in zip(t, t[1:] + t[:1], strict=True):
            other = owner.setdefault((min(a, b), max(a, b)), k)
            label[root(k)] = root(other)
    roots = np.array([root(k) for k in range(len(faces))])
    return roots == np.bincount(roots).argmax()


def ragged(faces, size, rng, wander=0.0):
    """(m,) bool: some `size` faces that hang together, and what they cut off. `wander`: how often the
    newest face goes on, not any.
    """
    around = {}
    for k, t in enumerate(faces.tolist()):
        for v in t:
            around.setdefault(v, []).append(k)
    sides = [set() for _ in faces]
    for k, t in enumerate(faces.tolist()):
        for a, b in zip(t, t[1:] + t[:1], strict=True):
            sides[k] |= (set(around[a]) & set(around[b])) - {k}
    front = [rng.randrange(len(faces))]
    gone = set(front)
    while front and len(gone) < size:
        newest = wander > 0 and rng.random() < wander
        k = front.pop(-1 if newest else rng.randrange(len(front)))
        fresh = sorted(sides[k] - gone)
        if wander > 0:
            rng.shuffle(fresh)
        gone |= set(fresh)
        front += fresh
    found = np.zeros(len(faces), bool)
    found[list(gone)] = True
    rest = np.flatnonzero(~found)
    found[rest[~largest_piece(faces[rest])]] = True
    return found


def cut(vertices, faces, gone):
    """The mesh without the faces `gone` (m,) bool, and without loose vertices."""
    kept = faces[~gone]
    used, kept = np.unique(kept, return_inverse=True)
    return vertices[used], kept.reshape(-1, 3)
