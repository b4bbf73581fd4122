# SPDX-License-Identifier: GPL-3.0-or-later
"""The filling of a hole: its faces, and the vertices of the mesh around it."""

from dataclasses import dataclass

import numpy as np

_AT_ONCE = 1 << 20  # distances that are compared at a time: 8 MB


@dataclass(frozen=True)
class Patch:
    """Rows 0 … r - 1 are vertices of the rim, all others are new."""

    rim: np.ndarray  # (r,) ids in the mesh, ascending
    fresh: np.ndarray  # (k,) ids of the new vertices, which follow those of the mesh
    points: np.ndarray  # (r + k, 3)
    faces: np.ndarray  # (t, 3) rows, or (t, 4) for quads
    nearest: np.ndarray  # (r + k,) row of the nearest vertex of the rim

    @property
    def triangles(self) -> np.ndarray:
        """(t, 3) rows: its faces, with quads halved."""
        return self.faces[:, [[0, k, k + 1] for k in range(1, self.faces.shape[1] - 1)]].reshape(
            -1, 3
        )

    @classmethod
    def of(cls, faces: np.ndarray, points: np.ndarray, new: np.ndarray) -> "Patch":
        """`faces` (t, 3) or (t, 4) of ids: of the mesh at `points`, then of the `new` ones."""
        ids, rows = np.unique(faces, return_inverse=True)
        split = int(np.searchsorted(ids, len(points)))
        fresh = ids[split:]
        spots = np.concatenate([points[ids[:split]], new[fresh - len(points)]])
        return cls(ids[:split], fresh, spots, rows.reshape(faces.shape), _nearest(spots, split))


def _nearest(points: np.ndarray, known: int) -> np.ndarray:
    """(n,) the nearest of the first `known` points to each point."""
    centred = points - points[:known].mean(axis=0)
    rim = centred[:known]
    found = np.arange(len(points))
    step = max(1, _AT_ONCE // known)
    for begin in range(known, len(points), step):
        part = centred[begin : begin + step]
        # the part of the squared distances that depends on the vertex of the rim
        found[begin : begin + step] = ((rim**2).sum(axis=1) - 2.0 * part @ rim.T).argmin(axis=1)
    return found
