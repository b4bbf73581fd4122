# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns that a setting does not suit: of hulls on which Flow Lines swings, known by their creases and by faces that are long
there; and those of few sides, such as a cylinder of eight, that a crease angle leaves as prisms. No Blender.
"""

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
