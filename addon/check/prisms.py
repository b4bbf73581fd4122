# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns of few sides, such as a cylinder of eight, that a crease angle leaves as prisms. No Blender."""

import numpy as np

from .. import core
from ..control_arrays import ControlArrays
from ..settings import Settings

FEWEST = 8  # nuts have six sides
ALIKE = 0.1  # folds and widths of a regular turn differ by less; a bevelled square's do not


def prisms_text(cage: ControlArrays, settings: Settings) -> str:
    """What to do about regular turns whose sides stay flat, in one sentence; empty if there are none."""
    if not settings.use_crease_angle:
        return ""
    mesh = core.measured(cage)
    folds, inside = mesh.fold_angles
    marked = mesh.has_pair(core.crease_edges(cage, settings))
    sharp = inside & ~marked & (folds > np.degrees(settings.crease_angle))
    quads = cage.offsets[:-1][cage.face_sizes == 4]
    first = cage.corner_edges[np.concatenate([quads, quads + 1])]
    pair = np.stack([first, cage.corner_edges[np.concatenate([quads + 2, quads + 3])]], axis=1)
    pair = pair[sharp[pair].all(axis=1)]
    part = core.module().arrays.connected_parts(len(cage.edges), pair)
    middle = cage.positions[cage.edges].mean(axis=1)
    width = np.linalg.norm(middle[pair[:, 1]] - middle[pair[:, 0]], axis=1)
    sides = np.bincount(part[pair[:, 0]], minlength=part.max(initial=-1) + 1)
    regular = (sides == np.bincount(part[sharp], minlength=len(sides))) & (sides >= FEWEST)
    for values, at in ((folds[sharp], part[sharp]), (width, part[pair[:, 0]])):
        low, high = np.full(len(sides), np.inf), np.zeros(len(sides))
        np.minimum.at(low, at, values)
        np.maximum.at(high, at, values)
        regular &= high - low <= ALIKE * high
    if not regular.any():
        return ""
    fewest = int(sides[regular].min())
    fold = folds[sharp & regular[part]].max()
    return (
        f"A turn of {fewest} sides stays a prism, since its folds of {fold:.0f}° are sharp: for a round one raise "
        "Crease Angle above that, or add sides."
    )
