# SPDX-License-Identifier: GPL-3.0-or-later
"""What fair() and Solver.solve() return."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np


class Result:
    """A refined surface.

    vertices: (N, 3) float64; rows 0 .. n-1 are the control vertices, in the caller's order.
    faces: (triangles (T, 3), quads (Q, 4)) int32, counter-clockwise; a control quad stays quads.
    triangle_polygon, quad_polygon: (T,) and (Q,) int32, the input face that each output face comes
    from.
    crease_edges: (k, 2) int32, the control edges that became creases, by whatever rule.
    shapes: list of (N, 3) float64, the surface of each shape; its rows go with those of vertices.
    report: what the run did; see docs/numpy-api.md for its keys.
    """

    def __init__(self, arrays: dict[str, Any]):
        self.vertices: np.ndarray = arrays["vertices"]
        self.faces: tuple[np.ndarray, np.ndarray] = (arrays["triangles"], arrays["quads"])
        self.triangle_polygon: np.ndarray = arrays["triangle_polygon"]
        self.quad_polygon: np.ndarray = arrays["quad_polygon"]
        self.crease_edges: np.ndarray = arrays["crease_edges"]
        self.shapes: list[np.ndarray] = arrays["shapes"]
        self.report: dict[str, Any] = arrays["report"]

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
