# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfers values between two meshes: element by element if their faces are equal, else from the
nearest places.
"""

from functools import cached_property
from typing import Any

import numpy as np
from mathutils.bvhtree import BVHTree

from ..core import ControlArrays, are_equal, measured
from ..triangles import fans
from .layers import STORAGE, Attribute

# relative offset to a face's centre, which tells on which side of a seam a corner is
_INWARD = 0.05


class Samples:
    """From the elements of `old` to those of `new`, two meshes of nearly the same shape."""

    def __init__(self, old: ControlArrays, new: ControlArrays) -> None:
        self.keeps_ids = len(old.positions) == len(new.positions) and are_equal(
            (old.corners, old.offsets, old.edges), (new.corners, new.offsets, new.edges)
        )
        self._old, self._new = old, new
        self._known: dict[str, tuple[np.ndarray, np.ndarray]] = {}  # by domain

    def of(self, attribute: Attribute) -> np.ndarray | None:
        if attribute.domain == "EDGE" and not self.keeps_ids:
            return None
        return self.values(attribute.values, attribute.domain, STORAGE[attribute.data_type].mixable)

    def values(self, values: np.ndarray, domain: str, mixable: bool) -> np.ndarray:
        """(size, …) values of old elements of `domain` → of new ones; interpolated if `mixable`."""
        if self.keeps_ids:
            return values
        if not len(self._triangles[0]):
            new = self._new
            of = {"POINT": new.positions, "CORNER": new.corners, "FACE": new.face_sizes}[domain]
            return np.zeros((len(of), *values.shape[1:]), values.dtype)
        if domain not in self._known:
            self._known[domain] = self._find(domain)
        ids, weights = self._known[domain]
        if domain == "FACE":
            return values[ids]
        if mixable:
            return np.einsum("ij,ij...->i...", weights, values[ids].astype(np.float64))
        return values[np.take_along_axis(ids, weights.argmax(axis=1)[:, None], axis=1)[:, 0]]

    def _find(self, domain: str) -> tuple[np.ndarray, np.ndarray]:
        """Old elements with weights (k, 3) for each new one; for faces only their ids (k,)."""
        new, (triangles, faces) = self._new, self._triangles
        centres = measured(new).face_centres
        if domain == "FACE":
            return faces[self._nearest(centres)], np.empty(0)
        places = new.positions
        sought = places
        if domain == "CORNER":
            places = new.positions[new.corners]
            sought = places + _INWARD * (centres[new.face_of] - places)
        found = triangles[self._nearest(sought)]
        weights = _barycentric(self._old.positions[self._old.corners[found]], places)
        return (found if domain == "CORNER" else self._old.corners[found]), weights

    @cached_property
    def _triangles(self) -> tuple[np.ndarray, np.ndarray]:
        """(t, 3) corners of the old mesh as triangles, fans of its faces, and (t,) their faces."""
        return fans(self._old.offsets[:-1], np.diff(self._old.offsets))

    @cached_property
    def _tree(self) -> Any:
        triangles = self._old.corners[self._triangles[0]].tolist()
        return BVHTree.FromPolygons(self._old.positions.tolist(), triangles, all_triangles=True)

    def _nearest(self, places: np.ndarray) -> np.ndarray:
        """(k,) the nearest old triangle for each place."""
        find = self._tree.find_nearest
        return np.array([find(place)[2] or 0 for place in places.tolist()], np.int64)


def _barycentric(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(k, 3) weights of the corners (k, 3, 3) at the projections of the places to their planes."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = places - corners[:, 0]
    aa, ab, bb = ((x * y).sum(axis=1) for x, y in ((a, a), (a, b), (b, b)))
    pa, pb = (p * a).sum(axis=1), (p * b).sum(axis=1)
    area = aa * bb - ab * ab
    safe = np.where(area > 0.0, area, 1.0)
    u = np.where(area > 0.0, (bb * pa - ab * pb) / safe, 0.0)
    v = np.where(area > 0.0, (aa * pb - ab * pa) / safe, 0.0)
    return np.stack([1.0 - u - v, u, v], axis=1)
