# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a surface that a piece owns."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import written
from .numbering import Numbering, closed_ids

if TYPE_CHECKING:
    from .piece import Piece


@dataclass(frozen=True, eq=False, repr=False)
class Part:
    """The part of a surface that one piece owns: its faces, and the points in no lower piece.

    Can be pickled. Faces take no room: they are arithmetic on the few
    numbers that each control face has.

    index: of the piece.
    vertex_points (a, 3), edge_points (b, n - 1, 3), triangle_points and quad_points (f, inside, 3):
    points at control vertices, inside control edges and control faces, with vertex_id (a,) and
    edge_id (b,); those inside faces belong to face_id, triangles and quads each in its order.
    face, side_edge, side_reversed: (F, 4), quads_before, polygon: (F,): the owned control faces.
    What begins with "seam" is what the piece makes of points that others own.
    shapes: by the number of each shape, all "…_points" of it.
    report: of the run.
    surface: what all parts agree on.
    """

    index: int
    surface: dict[str, Any]
    vertex_id: np.ndarray
    vertex_points: np.ndarray
    edge_id: np.ndarray
    edge_points: np.ndarray
    triangle_points: np.ndarray
    quad_points: np.ndarray
    face: np.ndarray
    side_edge: np.ndarray
    side_reversed: np.ndarray
    face_id: np.ndarray
    quads_before: np.ndarray
    polygon: np.ndarray
    seam_vertex_id: np.ndarray
    seam_vertex_points: np.ndarray
    seam_edge_id: np.ndarray
    seam_edge_points: np.ndarray
    shapes: dict[str, dict[str, np.ndarray]]
    report: dict[str, Any]

    @property
    def numbering(self) -> Numbering:
        names = ("levels", "vertices", "edges", "triangles", "quads")
        return Numbering(*(self.surface[name] for name in names))

    @property
    def vertices(self) -> np.ndarray:
        """(N, 3): the owned points; a copy."""
        blocks = (self.vertex_points, self.edge_points, self.triangle_points, self.quad_points)
        return np.concatenate([block.reshape(-1, 3) for block in blocks])

    @property
    def ids(self) -> np.ndarray:
        """(N,) int64: the ids of `vertices` in the whole surface."""
        runs = (*self._edge_rows(), *self._face_rows())
        return np.concatenate([self.vertex_id.astype(np.int64), *(rows.ravel() for rows in runs)])

    def _edge_rows(self) -> list[np.ndarray]:
        inside = np.arange(self.numbering.n - 1)
        return [self.numbering.edge_bases(self.edge_id)[:, None] + inside]

    def _face_rows(self) -> list[np.ndarray]:
        """Rows of the points inside triangles and inside quads: (f, inside) each."""
        out = []
        for kind in (False, True):
            which = self.is_quad == kind
            base = self.numbering.face_bases(self.face_id[which], self.quads_before[which])
            count = self.numbering.lattice(kind).interior_count
            out.append(base[:, None] + np.arange(count))
        return out

    @property
    def is_quad(self) -> np.ndarray:
        return self.face[:, 3] >= 0

    @property
    def faces(self) -> tuple[np.ndarray, np.ndarray]:
        """(triangles (T, 3), quads (Q, 4)) int64, with vertex ids of the whole surface; other parts own
        some of these vertices.
        """
        made = []
        for kind in (False, True):
            which = np.flatnonzero(self.is_quad == kind)
            lattice = self.numbering.lattice(kind)
            k = lattice.size
            ids = closed_ids(
                self.numbering,
                self.face[which, :k],
                self.side_edge[which, :k],
                self.side_reversed[which, :k],
                self.numbering.face_bases(self.face_id[which], self.quads_before[which]),
                lattice,
            )
            made.append(ids[:, lattice.cells].reshape(-1, k))
        return made[0], made[1]

    def write_into(self, vertices: np.ndarray) -> None:
        """Writes the owned points into the vertices (N, 3) of the whole, in memory or on disk."""
        vertices[self.vertex_id] = self.vertex_points
        vertices[self._edge_rows()[0]] = self.edge_points
        for rows, points in zip(self._face_rows(), (self.triangle_points, self.quad_points)):
            vertices[rows] = points

    def of_shape(self, shape: int) -> Part:
        of_shape: dict[str, Any] = dict(self.shapes[str(shape)])
        return replace(self, shapes={}, **of_shape)

    def seam_ids(self) -> np.ndarray:
        """(s,) int64: ids of the points of this part that other parts own."""
        inside = np.arange(self.numbering.n - 1)
        rows = self.numbering.edge_bases(self.seam_edge_id)[:, None] + inside
        return np.concatenate([self.seam_vertex_id.astype(np.int64), rows.ravel()])

    def seam_points(self) -> np.ndarray:
        """(s, 3): this part's positions of these points."""
        return np.concatenate([self.seam_vertex_points, self.seam_edge_points.reshape(-1, 3)])

    def __repr__(self) -> str:
        return (
            f"Part({self.index} of {self.surface['count']}, {len(self.face)} control faces, "
            f"{len(self.ids)} points)"
        )


NUMBERS = (
    "iterations",
    "residuals",
    "converged",
    "seconds",
    "predicted_bytes",
    "peak_bytes",
    "constraint_rounds",
    "constraint_gap",
    "normals",
    "threads",
)


def report_of(
    piece: Piece, report: dict[str, Any] | None, vertex_id: np.ndarray, surfaces: list[np.ndarray]
) -> dict[str, Any]:
    """A part's report: the run's numbers, and the values at vertices that the piece owns.

    `surfaces`: for the mesh and each shape, the points (a, 3) at these vertices.
    """
    count = piece.surface["input_vertices"]
    own = vertex_id < count
    row = np.searchsorted(piece.vertex_id, vertex_id[own])
    moved = [
        float(np.linalg.norm(points[own] - held[row], axis=1).max(initial=0.0))
        for points, held in zip(surfaces, (piece.vertices, *piece.shapes))
    ]
    out: dict[str, Any] = {"largest_deviation": moved[0], "warnings": [], "shapes": []}
    if report is None:  # outside the region
        out |= {"iterations": [], "residuals": [], "converged": True, "seconds": {}, "threads": 1}
        out |= {"predicted_bytes": 0, "peak_bytes": 0, "constraint_rounds": 0, "constraint_gap": 0}
        out |= {"normals": {"fixed": 0, "largest_angle": 0.0}, "pad_widths": np.zeros(len(row))}
        return out
    out |= {name: report[name] for name in NUMBERS}
    out["shapes"] = [
        {**shape, "largest_deviation": far} for shape, far in zip(report["shapes"], moved[1:])
    ]
    widths = np.asarray(report["pads"]["widths"], float)
    out["pad_widths"] = widths[row] if len(widths) else widths
    out["pads"] = {"gone": report["pads"]["gone"]}
    out["warnings"] = [
        in_whole
        for warning in report["warnings"]
        if (in_whole := _in_whole(piece, warning, vertex_id)) is not None
    ]
    return out


def _in_whole(
    piece: Piece, warning: dict[str, Any], vertex_id: np.ndarray
) -> dict[str, Any] | None:
    """A warning with ids of the whole; None if it concerns the cut, or elements of other pieces."""
    if not warning["elements"]:
        return written({**warning, "cause": f"Piece {piece.index}: {warning['cause']}"})
    if warning["kind"] != "vertex":
        return None  # it concerns the mesh, and the whole's outline has it already
    ids = piece.vertex_id[np.asarray(warning["elements"])]
    ids = ids[np.isin(ids, vertex_id)].tolist()
    if not ids:
        return None
    return written({**warning, "elements": ids})
