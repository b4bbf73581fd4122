# SPDX-License-Identifier: GPL-3.0-or-later
"""The decisions for a whole mesh (native/fairing/outline.h), and which piece owns an element."""

from __future__ import annotations

import hashlib
from functools import cached_property
from typing import Any

import numpy as np

from .. import _native
from ..arrays import pair_keys
from ..errors import written_report
from .numbering import ControlFaces, Numbering


class Outline:
    """The control mesh with its faces split and turned, its edges numbered and its curves refined.

    Ids are those of the result. control: its F control faces; edge: (E, 2) vertices. curve_points:
    (1 + k, c, n - 1, 3), and centres: (1 + k, p, 3), of the mesh and its k shapes. shapes: (k, V, 3), of the
    mended mesh.
    """

    def __init__(
        self,
        points: np.ndarray,
        corners: np.ndarray,
        offsets: np.ndarray,
        shapes: np.ndarray,
        options: _native.Options,
    ):
        found: dict[str, Any] = _native.outline(
            points, corners, offsets, shapes, options, _native.Monitor()
        )
        self.input_vertices = len(points)
        self.vertices: np.ndarray = found["vertices"]
        self.corners: np.ndarray = found["corners"]
        self.offsets: np.ndarray = found["offsets"]
        self.mended: dict[str, Any] | None = found["mended"]
        self.options: _native.Options = found["options"]
        self.edge: np.ndarray = found["edge"]
        self.edge_kind: np.ndarray = found["edge_kind"]
        self.curve: np.ndarray = found["curve"]
        inside = (1 << int(options.levels)) - 1
        curves = (1 + len(shapes), len(self.curve), inside, 3)
        self.curve_points: np.ndarray = found["curve_points"].reshape(curves)
        self.shapes: np.ndarray = found["shapes"].reshape(len(shapes), len(self.vertices), 3)
        self.units: tuple[float, float, float, float] = found["units"]
        self.report: dict[str, Any] = written_report(found)["report"]
        self.centres: np.ndarray = found["centres"].reshape(1 + len(shapes), -1, 3)
        quad = found["face"][:, 3] >= 0
        self.control = ControlFaces(
            found["face"],
            found["side_edge"],
            found["side_reversed"],
            np.arange(len(quad)),
            np.cumsum(quad) - quad,
            found["polygon"],
        )
        vertices, quads = len(points) + self.centres.shape[1], int(quad.sum())
        numbers = vertices, len(self.edge), len(quad) - quads, quads
        self.numbering = Numbering(int(options.levels), *numbers)

    @property
    def polygon_count(self) -> int:
        return len(self.offsets) - 1

    def middles(self) -> np.ndarray:
        """(m, 3): the mean corner of each face."""
        size = np.diff(self.offsets)
        sums = np.add.reduceat(self.vertices[self.corners], self.offsets[:-1], axis=0)
        return sums / size[:, None]

    @cached_property
    def fingerprint(self) -> str:
        """A hash of the mesh and its refinement, equal for all parts of one surface."""
        digest = hashlib.sha256(repr(self.numbering).encode())
        for array in (self.vertices, self.corners, self.offsets):
            digest.update(np.ascontiguousarray(array).data)
        return digest.hexdigest()[:16]

    def is_(self, bit: int) -> np.ndarray:
        """(E,) bool: whether an edge is of this kind, a bit defined in _native."""
        return (self.edge_kind & bit) != 0

    def crease_edges(self) -> np.ndarray:
        """(k, 2) int32: Result.crease_edges."""
        inside = self.is_(_native.curve_edge) & ~self.is_(_native.boundary_edge)
        return self.edge[inside].astype(np.int32)

    def on_edges(self, pairs: Any, values: Any) -> np.ndarray:
        """(E,): `values` on the edges `pairs` (k, 2), zero on all other edges."""
        keys = pair_keys(self.edge)
        order = np.argsort(keys)
        place = np.searchsorted(keys[order], pair_keys(np.asarray(pairs, np.int64)))
        out = np.zeros(len(keys))
        out[order[place]] = values
        return out

    @cached_property
    def edge_uses(self) -> np.ndarray:
        """(E,): the number of faces at each edge."""
        sides = self.control.edge
        return np.bincount(sides[sides >= 0], minlength=len(self.edge))

    def vertex_owner(self, labels: np.ndarray) -> np.ndarray:
        """(V,): the lowest piece around each vertex, with `labels` of the polygons; -1 without faces."""
        its = self.control
        return _lowest(its.vertex, labels[its.polygon], self.numbering.vertices)

    def edge_owner(self, labels: np.ndarray) -> np.ndarray:
        """(E,): the lowest piece beside each edge."""
        return _lowest(self.control.edge, labels[self.control.polygon], len(self.edge))


def _lowest(elements: np.ndarray, label: np.ndarray, count: int) -> np.ndarray:
    face, side = np.nonzero(elements >= 0)
    none = np.iinfo(np.int32).max
    out = np.full(count, none, np.int32)
    np.minimum.at(out, elements[face, side], label[face].astype(np.int32))
    return np.where(out == none, -1, out)
