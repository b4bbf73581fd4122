# SPDX-License-Identifier: GPL-3.0-or-later
"""Hulls on which Flow Lines swings, known by their creases and by faces that are long at turns. No Blender."""

import numpy as np

from .. import core
from ..control_arrays import ControlArrays
from ..settings import Settings

# length of an edge over the radius of the turn across it, above which sections relax between their
# stations: Bending is nearer to sampled hulls from about 2 on (docs/developers/notes/figures.md)
_LONG = 3.0
SHARP = np.radians(60)  # folds around the flat ends of a closed body, which are meant sharp
_NEAR = 1e-6  # of the size: distance of vertices that count as in the symmetry plane


def has_flat_ends(cage: ControlArrays) -> bool:
    """Whether a closed body has flat parts with sharp edges all around, such as the caps of a rudder."""
    mesh, flats = core.measured(cage), core.module().flats
    if (mesh.edge_uses != 2).any():
        return False
    folds, _ = mesh.fold_angles
    part, plane = flats.plane_parts(mesh, folds <= flats.ANGLE)
    ends = part[mesh.faces_of_edges]
    soft = (ends[:, 0] != ends[:, 1]) & (folds <= np.degrees(SHARP))
    plane[ends[soft]] = False
    return bool(plane.any() and not plane[part].all())  # a box is no hull with ends


def why_bending(cage: ControlArrays, settings: Settings) -> str:
    """Why Flow Lines would swing on this hull, as half a sentence; empty if it would not."""
    if has_flat_ends(cage):
        return "it is closed, with flat ends"
    creases = core.crease_edges(cage, settings)
    if _ends_inside(cage, creases, settings.symmetry_plane):
        return "a crease ends inside"
    length = _longest(cage, creases)
    return f"faces are up to {length:.0f} radii long at a turn" if length > _LONG else ""


def _ends_inside(cage: ControlArrays, creases: np.ndarray, plane: str) -> bool:
    """Whether a crease (k, 2) ends inside the surface, such as that of a sharp stem at a round keel."""
    border = cage.border_edges
    if plane != "NONE":
        across = cage.positions[:, "XYZ".index(plane)]
        near = np.abs(across) <= _NEAR * np.ptp(cage.positions, axis=0).max(initial=0.0)
        border = border[~near[border].all(axis=1)]
    ends = np.bincount(creases.ravel(), minlength=len(cage.positions)) == 1
    ends[border] = False
    return bool(ends.any())


def _longest(cage: ControlArrays, creases: np.ndarray) -> float:
    """The largest length of a smooth edge over the radius of the turn across it: its angle times its
    length over the mean width of its two faces.
    """
    mesh = core.measured(cage)
    angles, inside = mesh.fold_angles
    smooth = inside & ~mesh.has_pair(creases)
    both = mesh.face_areas[mesh.faces_of_edges[smooth]].mean(axis=1)
    lengths = np.radians(angles[smooth]) * mesh.edge_lengths[smooth] ** 2 / both
    return float(lengths.max(initial=0.0))
