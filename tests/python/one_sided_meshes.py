# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes of one-sided sheets, with their double covers as meshes of their own."""

import control_meshes as meshes
import numpy as np


def strip(around: int = 9, across: int = 3, triangles: bool = False, cover: bool = False):
    """A Möbius strip about z that a turn about x maps to itself; `cover`: its double cover."""
    turns = 2 * around if cover else around
    angle = 2 * np.pi * np.arange(turns) / around
    width = np.linspace(-1, 1, across + 1)[:, None]
    out = np.stack(
        [np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)],
        -1,
    )[:, None]
    centre = 2 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], -1)[:, None]
    vertices = (centre + width * out).reshape(-1, 3)
    id = np.arange(len(vertices)).reshape(turns, across + 1)
    after = np.roll(id, -1, axis=0)
    if not cover:
        after[-1] = after[-1, ::-1].copy()
    quads = np.stack([id[:, :-1], after[:, :-1], after[:, 1:], id[:, 1:]], -1).reshape(-1, 4)
    if cover:  # to the last bit
        half = len(vertices) // 2
        vertices[half:] = vertices[:half].reshape(around, -1, 3)[:, ::-1].reshape(-1, 3)
        quads[len(quads) // 2 :] = np.roll(quads[len(quads) // 2 :], 1, axis=1)  # cut the same way
    if triangles:
        return meshes.cut_quads((vertices, quads))
    return vertices, quads


def core(around: int = 9, across: int = 2):
    """Edges along the middle of a strip: a loop that goes around once."""
    middle = np.arange(around) * (across + 1) + across // 2
    return np.stack([middle, np.roll(middle, -1)], -1)


def klein_bottle(around: int = 8, across: int = 6):
    """Quads of the figure-eight immersion, a closed surface."""
    u = 2 * np.pi * np.arange(around)[:, None] / around
    v = 2 * np.pi * (np.arange(across)[None] + 0.5) / across
    eight = np.sin(v), np.sin(2 * v)
    radius = 3 + np.cos(u / 2) * eight[0] - np.sin(u / 2) * eight[1]
    height = np.sin(u / 2) * eight[0] + np.cos(u / 2) * eight[1]
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), height], -1).reshape(-1, 3)
    id = np.arange(around * across).reshape(around, across)
    after = np.roll(id, -1, axis=0)
    after[-1] = after[-1, ::-1].copy()  # where u begins again, v runs backwards
    right, up = np.roll(id, -1, axis=1), np.roll(after, -1, axis=1)
    return vertices, np.stack([id, after, up, right], -1).reshape(-1, 4)
