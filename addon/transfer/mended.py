# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that the core faired: the control mesh, or its mended form."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core import ControlArrays


@dataclass(frozen=True)
class FairedMesh:
    """Its own `arrays`, with the vertices and edges of the control mesh under their ids."""

    arrays: ControlArrays
    # the faces in `arrays` of refined triangles and of refined quads
    polygons: tuple[np.ndarray, np.ndarray]
    # (c, 2) corners of the control mesh from which each corner is interpolated
    origin: np.ndarray | None
    share: np.ndarray | None  # (c,) float64, share of the second one

    def corner(self, values: np.ndarray) -> np.ndarray:
        """(control corners, w) numbers → (c, w), interpolated."""
        if self.origin is None or self.share is None:
            return values
        share = self.share[:, None]
        return (1.0 - share) * values[self.origin[:, 0]] + share * values[self.origin[:, 1]]

    def pick_corner(self, values: np.ndarray) -> np.ndarray:
        """(control corners, …) of any type → (c, …), from the nearer one."""
        if self.origin is None or self.share is None:
            return values
        return values[np.where(self.share > 0.5, self.origin[:, 1], self.origin[:, 0])]


def faired_mesh(result: Any, arrays: ControlArrays) -> FairedMesh:
    """`result`: the core's; `arrays`: the control mesh."""
    mended = result.mended
    if mended is None:
        return FairedMesh(arrays, (result.triangle_polygon, result.quad_polygon), None, None)
    own = replace(
        arrays,
        edges=mended.vertex_origin[arrays.edges],
        corners=mended.corners.astype(np.int32),
        corner_edges=arrays.corner_edges[mended.corner_origin[:, 0]],
        offsets=mended.offsets.astype(np.int32),
    )
    polygons = (mended.triangle_face, mended.quad_face)
    return FairedMesh(own, polygons, mended.corner_origin, mended.corner_share)
