# SPDX-License-Identifier: GPL-3.0-or-later
"""All control faces of one kind with their refined faces, and how values spread over them. In chunks: no large copies."""

from dataclasses import dataclass

import numpy as np

from .cells import Cells
from .control_faces import ControlFaces

CHUNK = 1 << 18  # values at a time: these fit in a processor's cache


@dataclass(frozen=True)
class Patch:
    """The refined faces `fine` (F n², k) of the F control faces `faces`; their first corner is the mesh's `start`."""

    cells: Cells
    faces: ControlFaces
    fine: np.ndarray
    start: int

    def mix_corners(self, known, out):
        """Writes the mixed values at all refined corners; `known` (corners and centres, w), `out` (corners, w) float32."""
        own = self._own(out)
        for part, values in self._mixed(known, self.faces.corners):
            for w, lattice in enumerate(values):
                own[part, :, w] = np.take(lattice, self.cells.corner_point, axis=1)

    def mix_points(self, known, out):
        """The same at all refined vertices; `known` (vertices and centres, w), `out` (refined vertices, w) float32."""
        ids = self.fine.reshape(len(self.faces.polygon), -1)
        for part, values in self._mixed(known, self.faces.vertices):
            points = ids[part][:, self.cells.first_corner]
            out[points] = np.moveaxis(values, 0, 2)

    def pick_corners(self, values, ids, fans, out):
        """Writes the nearest of `values` (corners, …) at all refined corners; `ids` (F, k): where those of a face are.

        `fans` (F,) bool: faces whose last corner is a centre.
        """
        own = self._own(out)
        for part, picked in self._picked(ids, fans):
            own[part] = values[np.take(picked, self.cells.corner_point, axis=1)]

    def pick_points(self, values, ids, fans, out):
        """The same at all refined vertices."""
        fine = self.fine.reshape(len(self.faces.polygon), -1)
        for part, picked in self._picked(ids, fans):
            out[fine[part][:, self.cells.first_corner]] = values[picked]

    def _own(self, out):
        """The part of `out` (corners, …) that belongs to these faces, by control face."""
        own = out[self.start : self.start + self.fine.size]
        return own.reshape(len(self.faces.polygon), -1, *out.shape[1:])

    def _chunks(self, width):
        faces = len(self.faces.polygon)
        step = max(1, CHUNK // (len(self.cells.points) * width))
        return (slice(begin, min(begin + step, faces)) for begin in range(0, faces, step))

    def _mixed(self, known, ids):
        """Chunks of faces, and their values (w, faces, P) float32 at all points."""
        width, size = known.shape[1], self.faces.size
        spread = self.cells.weights.T / self.cells.total
        for part in self._chunks(width):
            corners = np.moveaxis(known[ids[part]].astype(np.float64, copy=False), 2, 0)
            mixed = np.ascontiguousarray(corners).reshape(-1, size) @ spread
            yield part, mixed.astype(np.float32).reshape(width, -1, len(self.cells.points))

    def _picked(self, ids, fans):
        """Chunks of faces, and the id (faces, P) int32 of `ids` (F, k) that is nearest to each point."""
        nearest = _nearest(self.cells)
        for part in self._chunks(self.faces.size):
            # of equally near ones the lowest vertex, so that faces with a common edge agree on it
            order = np.where(nearest[fans[part].astype(np.intp)], self.faces.vertices[part, None, :], _NEVER)
            yield part, np.take_along_axis(ids[part], order.argmin(axis=2), axis=1)


_NEVER = np.iinfo(np.int32).max


def _nearest(cells):
    """(2, P, k) bool: the corners nearest to each point; in a plain face, and in one whose last corner is a centre.

    A centre is nearest to itself only.
    """
    plain = cells.weights == cells.weights.max(axis=1, keepdims=True)
    rest = cells.weights[:, :-1]
    fan = np.zeros_like(plain)
    fan[:, :-1] = rest == rest.max(axis=1, keepdims=True)
    fan[cells.apex] = plain[cells.apex]
    return np.stack([plain, fan])
