# SPDX-License-Identifier: GPL-3.0-or-later
"""A refined surface with fewer of its points. Plain arrays, no Blender."""

import numpy as np

from .attributes import AttributeTransfer, Patch
from .lattice import make_cells


def coarse_triangles(transfer: AttributeTransfer, levels: int) -> tuple[np.ndarray, np.ndarray]:
    """(t, 3) refined vertices on the lattice of `levels`, and (t,) the control face of each."""
    triangles, owners = [np.empty((0, 3), np.int32)], [np.empty(0, np.int64)]
    start = 0
    for patch in transfer.patches:
        faces = _coarse_faces(patch, levels)
        each = faces.shape[1]
        halves = [[0, 1, 2]] if faces.shape[2] == 3 else [[0, 1, 2], [0, 2, 3]]
        owner = np.repeat(start + np.arange(len(faces)), each)
        for half in halves:
            triangles.append(faces[:, :, half].reshape(-1, 3))
            owners.append(owner)
        start += len(faces)
    return np.concatenate(triangles), np.concatenate(owners)


def _coarse_faces(patch: Patch, levels: int) -> np.ndarray:
    """(F, 4^levels, k) refined vertices."""
    size = patch.faces.size
    cells, coarse = patch.cells, make_cells(size, levels)
    i, j = (coarse.points * (cells.lattice.n >> levels)).T
    corner = cells.first_corner[cells.lattice.at(i, j)][coarse.corner_point]
    fine = patch.fine.reshape(len(patch.faces.polygon), -1)
    return fine[:, corner].reshape(len(fine), -1, size)
