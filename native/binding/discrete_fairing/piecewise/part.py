# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a surface that a piece owns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import written
from .numbering import ControlFaces, Numbering

if TYPE_CHECKING:
    from .piece import Piece


@dataclass(frozen=True, eq=False, repr=False)
class Part:
    """The part of a surface that one piece owns: its faces, and the points in no lower piece.

    Can be pickled. Faces take no room: they are arithmetic on the few numbers that each control face has.

    index: of the piece.
    surface: what all parts agree on.
    ids: (N,) int64, ascending, of the owned points in the whole surface; vertices: (N, 3), their positions.
    shapes: (N, 3) for each shape.
    seam_ids: (s,) int64, of the points that other parts own; seam_points: (s, 3), where this part has them.
    control: the owned control faces.
    report: of the run.
    """

    index: int
    surface: dict[str, Any]
    ids: np.ndarray
    vertices: np.ndarray
    shapes: list[np.ndarray]
    seam_ids: np.ndarray
    seam_points: np.ndarray
    control: ControlFaces
    report: dict[str, Any]

    @property
    def numbering(self) -> Numbering:
        return self.surface["numbering"]

    @property
    def vertex_ids(self) -> np.ndarray:
        """(v,) the first of `ids`: those of the caller's vertices."""
        return self.ids[: np.searchsorted(self.ids, self.surface["input_vertices"])]

    @property
    def faces(self) -> tuple[np.ndarray, np.ndarray]:
        """(triangles (T, 3), quads (Q, 4)) int64, with vertex ids of the whole surface; other parts own
        some of these vertices.
        """
        made = []
        for quad in (False, True):
            cells = self.numbering.lattice(quad).cells
            ids = self.control.points(self.numbering, quad)
            made.append(ids[:, cells].reshape(-1, cells.shape[1]))
        return made[0], made[1]

    def write_into(self, vertices: np.ndarray) -> None:
        """Writes the owned points into the vertices (N, 3) of the whole, in memory or on disk."""
        vertices[self.ids] = self.vertices

    def __repr__(self) -> str:
        return (
            f"Part({self.index} of {self.surface['count']}, {len(self.control.number)} control faces, "
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
    piece: Piece, report: dict[str, Any] | None, owned: np.ndarray, surfaces: list[np.ndarray]
) -> dict[str, Any]:
    """A part's report: the run's numbers, and the values at the caller's vertices `owned` (a,), ids.

    `report`: None outside the region; `surfaces`: for the mesh and each shape, the points (a, 3) at these.
    """
    row = np.searchsorted(piece.vertex_id, owned)
    moved = [
        float(np.linalg.norm(points - held[row], axis=1).max(initial=0.0))
        for points, held in zip(surfaces, (piece.vertices, *piece.shapes))
    ]
    out: dict[str, Any] = {"largest_deviation": moved[0], "warnings": [], "shapes": []}
    if report is None:
        return out | {"converged": True, "pad_widths": np.zeros(len(row))}
    out |= {name: report[name] for name in NUMBERS}
    out["shapes"] = [
        {**shape, "largest_deviation": far} for shape, far in zip(report["shapes"], moved[1:])
    ]
    widths = np.asarray(report["pads"]["widths"], float)
    out["pad_widths"] = widths[row] if len(widths) else widths
    out["pads"] = {"gone": report["pads"]["gone"]}
    named = (_in_whole(piece, warning, owned) for warning in report["warnings"])
    out["warnings"] = [warning for warning in named if warning is not None]
    return out


def _in_whole(piece: Piece, warning: dict[str, Any], owned: np.ndarray) -> dict[str, Any] | None:
    """A warning with ids of the whole; None if it concerns the cut, or elements of other pieces."""
    if not warning["elements"]:
        return written({**warning, "cause": f"Piece {piece.index}: {warning['cause']}"})
    if warning["kind"] != "vertex":
        return None  # it concerns the mesh, and the whole's outline has it already
    ids = piece.vertex_id[np.asarray(warning["elements"])]
    ids = ids[np.isin(ids, owned)].tolist()
    return written({**warning, "elements": ids}) if ids else None
