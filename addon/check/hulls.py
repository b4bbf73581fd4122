# SPDX-License-Identifier: GPL-3.0-or-later
"""Hulls on which Flow Lines swings, known by their creases and the length of their faces. No Blender."""

import numpy as np

from ..control_arrays import ControlArrays
from ..settings import Settings

# length of the faces over their width, from which Bending is nearer to sampled hulls: equal between 6
# and 9 (docs/developers/notes/figures.md)
_LONG = 6.0
_NEAR = 1e-6  # of the size: distance of vertices that count as in the symmetry plane


def why_bending(cage: ControlArrays, settings: Settings) -> str:
    """Why Flow Lines would swing on this hull, as half a sentence; empty if it would not."""
    if _ends_inside(cage, settings):
        return "a crease ends inside"
    length = _face_length(cage)
    return f"faces are {length:.0f} times as long as wide" if length > _LONG else ""


def _ends_inside(cage: ControlArrays, settings: Settings) -> bool:
    """Whether a crease ends inside the surface, such as that of a sharp stem at a round keel."""
    threshold = settings.crease_threshold if settings.use_crease_attribute else None
    creases = cage.crease_edges(threshold, settings.use_sharp_edges)
    border = cage.edges[cage.edge_uses == 1]
    if settings.symmetry_plane != "NONE":
        across = cage.positions[:, "XYZ".index(settings.symmetry_plane)]
        near = np.abs(across) <= _NEAR * np.ptp(cage.positions, axis=0).max(initial=0.0)
        border = border[~near[border].all(axis=1)]
    ends = np.bincount(creases.ravel(), minlength=len(cage.positions)) == 1
    ends[border] = False
    return bool(ends.any())


def _face_length(cage: ControlArrays) -> float:
    """The median over the quads of the longer sides over the shorter ones; 1 without quads."""
    starts = cage.offsets[:-1][cage.face_sizes == 4]
    if not len(starts):
        return 1.0
    points = cage.positions[cage.corners[starts[:, None] + np.arange(4)]]
    sides = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2)
    across = sides[:, :2] + sides[:, 2:]
    shorter = np.maximum(across.min(axis=1), np.finfo(float).tiny)
    return float(np.median(across.max(axis=1) / shorter))
