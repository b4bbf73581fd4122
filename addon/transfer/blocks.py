# SPDX-License-Identifier: GPL-3.0-or-later
"""Divides a large mesh into blocks of faces with their surroundings, for local computations, so that
the cost of each depends on its size only.
"""

from collections.abc import Iterator

import numpy as np

from ..core import ControlArrays
from ..triangles import marked
from .cut_out import CutOut, cut_out


def blocks(
    arrays: ControlArrays, chosen: np.ndarray, most: int, around: float
) -> Iterator[tuple[CutOut, np.ndarray]]:
    """(cut-out, (f,) bool: whether a face is the block's own): together the own faces are the faces
    `chosen` (m,) bool, at most `most` a block. A cut-out also has all faces whose centres are within
    `around`, a length, of the bounding box of its own.

    Blocks are halved across the longest axis, recursively, so that no step reads more than it divides.
    """
    whole = CutOut(arrays, np.arange(len(arrays.positions)), np.arange(len(chosen)))
    waiting = [(whole, chosen)] if chosen.any() else []
    while waiting:
        part, own = waiting.pop()
        if own.sum() <= most:
            yield part, own
            continue
        centres = _centres(part.arrays)
        rows = np.flatnonzero(own)
        axis = int(np.argmax(np.ptp(centres[rows], axis=0)))
        order = rows[np.argsort(centres[rows, axis], kind="stable")]
        for half in (order[len(order) // 2 :], order[: len(order) // 2]):
            waiting.append(_cut(part, centres, half, around))


def _cut(
    part: CutOut, centres: np.ndarray, rows: np.ndarray, around: float
) -> tuple[CutOut, np.ndarray]:
    low, high = centres[rows].min(axis=0) - around, centres[rows].max(axis=0) + around
    near = ((centres >= low) & (centres <= high)).all(axis=1)
    found = cut_out(part.arrays, near)
    own = marked(rows, len(near))
    whole = CutOut(found.arrays, part.vertices[found.vertices], part.faces[found.faces])
    return whole, own[found.faces]


def _centres(arrays: ControlArrays) -> np.ndarray:
    """(m, 3): means of the faces' corners."""
    sums = np.add.reduceat(arrays.positions[arrays.corners], arrays.offsets[:-1], axis=0)
    return sums / arrays.face_sizes[:, None]
