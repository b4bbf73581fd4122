# SPDX-License-Identifier: GPL-3.0-or-later
"""What fills a hole, as its faces and the vertices of the mesh that they stand on."""

from dataclasses import dataclass

import numpy as np

_AT_ONCE = 1 << 20  # distances that are compared at a time: 8 MB


@dataclass(frozen=True)
class Patch:
    """Rows 0 … r - 1 are vertices of the rim, all others are new."""

    rim: np.ndarray  # (r,) ids in the mesh, rising
    fresh: np.ndarray  # (k,) ids of the new vertices, which follow on those of the mesh
    points: np.ndarray  # (r + k, 3)
    faces: np.ndarray  # (t, 3) rows, or (t, 4) of quads
    nearest: np.ndarray  # (r + k,) row of the rim's vertex that is nearest

    @property
    def triangles(self) -> np.ndarray:
        """(t, 3) rows: its faces, quads halved."""
        return self.faces[:, [[0, k, k + 1] for k in range(1, self.faces.shape[1] - 1)]].reshape(
            -1, 3
        )

    @classmethod
    def of(cls, faces: np.ndarray, points: np.ndarray, new: np.ndarray) -> "Patch":
        """`faces` (t, 3) or (t, 4): ids, first of the mesh at `points` (n, 3), then of the `new` points (k, 3)."""
        ids, rows = np.unique(faces, return_inverse=True)
        split = int(np.searchsorted(ids, len(points)))
        fresh = ids[split:]
        spots = np.concatenate([points[ids[:split]], new[fresh - len(points)]])
        return cls(ids[:split], fresh, spots, rows.reshape(faces.shape), _nearest(spots, split))


def _nearest(points: np.ndarray, known: int) -> np.ndarray:
    """(n,) which of the first `known` points is nearest to each."""
    centred = points - points[:known].mean(axis=0)
    rim = centred[:known]
    found = np.arange(len(points))
    step = max(1, _AT_ONCE // known)
    for begin in range(known, len(points), step):
        part = centred[begin : begin + step]
        # of the squares of the distances, what differs from one vertex of the rim to another
        found[begin : begin + step] = ((rim**2).sum(axis=1) - 2.0 * part @ rim.T).argmin(axis=1)
    return found
