# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of fair() and Solver.solve()."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np


class Mended:
    """The mended mesh that was faired: m faces with c corners.

    Its vertices are the caller's, in their order; merged ones belong to no face.

    corners: (c,) int64, vertex ids, face after face.
    offsets: (m + 1,) int64: face f has the corners offsets[f] ... offsets[f + 1] - 1.
    vertex_origin: (n,) int32, the vertex that each was merged with; usually itself.
    face_origin: (m,) int32, the input face of each face, ascending.
    corner_origin: (c, 2) int32 and corner_share: (c,) float64: each corner is 1 - share of its
    first input corner and share of its second.
    triangle_face, quad_face: (T,) and (Q,) int32, the face of this mesh of each output face.
    """

    def __init__(self, arrays: dict[str, Any], triangle_face: np.ndarray, quad_face: np.ndarray):
        self.corners: np.ndarray = arrays["corners"]
        self.offsets: np.ndarray = arrays["offsets"]
        self.vertex_origin: np.ndarray = arrays["vertex_origin"]
        self.face_origin: np.ndarray = arrays["face_origin"]
        self.corner_origin: np.ndarray = arrays["corner_origin"]
        self.corner_share: np.ndarray = arrays["corner_share"]
        self.triangle_face = triangle_face
        self.quad_face = quad_face


class Result:
    """A refined surface.

    vertices: (N, 3) float64; rows 0 .. n-1 are the control vertices, in the caller's order.
    faces: (triangles (T, 3), quads (Q, 4)) int32, counter-clockwise; a control quad becomes quads.
    triangle_polygon, quad_polygon: (T,) and (Q,) int32, the input face of each output face.
    crease_edges: (k, 2) int32, the control edges that became creases, by any rule.
    shapes: list of (N, 3) float64, the surface of each shape, with the rows of vertices.
    mended: Mended, the mesh that was faired, if it is not the given one; else None.
    strain: (n,) float64, Strain.lengths, if fair() was asked for it; else None.
    report: dict; its keys are in docs/python/report.md.
    """

    def __init__(self, arrays: dict[str, Any]):
        self.vertices: np.ndarray = arrays["vertices"]
        self.faces: tuple[np.ndarray, np.ndarray] = (arrays["triangles"], arrays["quads"])
        self.triangle_polygon: np.ndarray = arrays["triangle_polygon"]
        self.quad_polygon: np.ndarray = arrays["quad_polygon"]
        self.crease_edges: np.ndarray = arrays["crease_edges"]
        self.shapes: list[np.ndarray] = arrays["shapes"]
        self.report: dict[str, Any] = arrays["report"]
        self.strain: np.ndarray | None = None
        mended = arrays["mended"]
        self.mended: Mended | None = (
            Mended(mended, arrays["triangle_mended"], arrays["quad_mended"]) if mended else None
        )

    @cached_property
    def triangles(self) -> np.ndarray:
        """(M, 3) int32: the whole surface; each quad is cut along its shorter diagonal."""
        triangles, quads = self.faces
        if not len(quads):
            return triangles
        corner = self.vertices[quads]
        first = np.linalg.norm(corner[:, 0] - corner[:, 2], axis=1)
        second = np.linalg.norm(corner[:, 1] - corner[:, 3], axis=1)
        halves = np.where(
            (first <= second)[:, None], quads[:, [0, 1, 2, 0, 2, 3]], quads[:, [1, 2, 3, 1, 3, 0]]
        )
        return np.concatenate([triangles, halves.reshape(-1, 3)])

    def __repr__(self) -> str:
        triangles, quads = self.faces
        return (
            f"Result({len(self.vertices)} vertices, {len(triangles)} triangles, {len(quads)} quads)"
        )
