# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh, or a part of one with the ids of the whole, for fillings, cleaning and pieces; and angles between vectors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .arrays import faces_by_vertex, fans, marked, ranges


@dataclass(frozen=True)
class MeshPart:
    points: np.ndarray  # (n, 3)
    corners: np.ndarray  # (c,)
    offsets: np.ndarray  # (m + 1,)
    vertex_ids: np.ndarray  # (n,) ids in the whole mesh, ascending
    face_ids: np.ndarray  # (m,) ids in the whole mesh

    @classmethod
    def of(cls, points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> MeshPart:
        return cls(points, corners, offsets, np.arange(len(points)), np.arange(len(offsets) - 1))

    def part(self, faces: np.ndarray) -> MeshPart:
        """A part with these faces and their vertices, which keep their order."""
        sizes = self.offsets[faces + 1] - self.offsets[faces]
        ids, corners = np.unique(self.corners_at(faces), return_inverse=True)
        offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        return MeshPart(self.points[ids], corners.astype(np.int64), offsets, ids, faces)

    def renumbered(self, loop: Sequence[int]) -> list[int]:
        """A loop of the whole mesh in this part's ids; the part must have all its vertices."""
        return np.searchsorted(self.vertex_ids, loop).tolist()

    def touching(self, vertices: np.ndarray) -> np.ndarray:
        """(f,) ids of the faces with one of these vertices."""
        at = np.flatnonzero(marked(vertices, len(self.points))[self.corners])
        return np.unique(np.searchsorted(self.offsets, at, side="right") - 1)

    def faces_at(self, vertices: np.ndarray) -> np.ndarray:
        """The same as touching(); faster for many calls with few vertices each."""
        faces, starts = self._faces_by_vertex
        return np.unique(faces[ranges(starts[vertices], starts[vertices + 1])])

    @cached_property
    def _faces_by_vertex(self) -> tuple[np.ndarray, np.ndarray]:
        return faces_by_vertex(self.corners, self.offsets, len(self.points))

    def corner_fans(self, faces: np.ndarray) -> np.ndarray:
        """(t, 3) triangles of these faces, as fans from their first corners."""
        return self.corners[fans(self.offsets[faces], self.offsets[faces + 1])]

    def corners_at(self, faces: np.ndarray) -> np.ndarray:
        """All corners of these faces, face after face."""
        return self.corners[ranges(self.offsets[faces], self.offsets[faces + 1])]


def angles_between(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(…) angles between vectors (…, 3), radians."""
    return np.arctan2(np.linalg.norm(np.cross(u, v), axis=-1), (u * v).sum(axis=-1))
