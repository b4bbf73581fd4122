# SPDX-License-Identifier: GPL-3.0-or-later
"""fit(): the fairest surface near a scan, from a control mesh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import fixed_vertices, index_array, vertex_array
from .converters import positive
from .errors import fairing_error, written_report
from .halves import Control, Half
from .options import CommonSettings
from .result import Result
from .watching import Progress, check_watchers


class Fitted(Result):
    """A refined surface near a scan of S points; its first rows are the control vertices, which have
    moved. Lengths are in mesh units; points are numbered as given, faces are the caller's.

    distances: (S,) float64 from the surface to every point, positive outside; NaN where no part of
    the surface has a normal that agrees.
    faces_of_points: (S,) int32, the face that each point lies over; -1: none.
    noise: float, the root mean square of the distances of points, robust against strays.
    weight: float, without a unit, how strongly the points pull: 1 halves a wave as long as the mean
    control edge, and waves half as long sixteen times more.
    within: (float, float), the distance that 95 % of the covered points are within, and the largest
    of all covered points that are no outliers.
    coverage: (m,) float64, the share of each face that has points; NaN: a face that mending dropped.
    too_coarse: (k,) int64, faces where the surface stays on one side of the points by more than the
    noise: to be split.
    outliers: (k,) int64, points farther off than eight times the noise, and those over no face.
    trials: list of (weight, distance): what points held out were off, root mean square.
    """

    def __init__(self, arrays: dict[str, Any]):
        super().__init__(arrays)
        self.distances: np.ndarray = arrays["distances"]
        self.faces_of_points: np.ndarray = arrays["faces_of_points"]
        self.noise: float = arrays["noise"]
        self.weight: float = arrays["weight"]
        self.within: tuple[float, float] = arrays["within"]
        self.coverage: np.ndarray = arrays["coverage"]
        self.too_coarse: np.ndarray = arrays["too_coarse"]
        self.outliers: np.ndarray = arrays["outliers"]
        self.trials: list[tuple[float, float]] = [(w, d) for w, d in arrays["trials"]]

    def __repr__(self) -> str:
        return (
            f"Fitted({len(self.vertices)} vertices, within {self.within[0]:.3g} of 95 % of "
            f"{len(self.distances)} points)"
        )


def fit(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    points: ArrayLike,
    *,
    triangles: ArrayLike | None = None,
    normals: ArrayLike | None = None,
    tolerance: float | None = None,
    weight: float | None = None,
    fixed: ArrayLike | None = None,
    levels: int = 2,
    symmetry_plane: str | None = None,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **settings: Unpack[CommonSettings],
) -> Fitted:
    """The fairest surface near a scan: the thin plate of a coarse control mesh, drawn to points.

    Each point pulls along the normal of the surface where it is nearest. Where there are none, the
    surface is as fair as its surroundings let it be; gross errors pull less, and in the end not at
    all. Distances are those from the smooth surface through the vertices, not from flat faces. Where
    the surface would fold, points pull less. Neither mesh is changed.

    Parameters
    ----------
    vertices, faces, levels, progress, monitor
        As of fair(): a control mesh drawn over the scan. Its vertices begin where they are and move.
    points : (S, 3) float
        The scan, in the unit of the vertices.
    triangles : (T, 3) int
        The scan as a mesh: its normals tell two near sheets apart.
    normals : (S, 3) float
        The same for points without triangles: outwards, of any length; zero where unknown.
    tolerance : float, mesh units
        The calmest surface with 95 % of the covered points within this distance. Where that cannot
        be kept, the report has the warning TOLERANCE_NOT_KEPT.
    weight : float, without a unit
        How strongly points pull (Fitted.weight). Without tolerance and weight, the one with which
        points held out are nearest to the surface.
    fixed : (n,) bool
        Control vertices that stay where they are, as points: there are no pads under them.
    symmetry_plane
        As of fair(); the scan is that of the whole, and both halves' points count.
    **settings
        Those of fair(), but for those that move control vertices. Without triangles boundary is "free".

    Raises
    ------
    FairingError
        As fair(); BAD_SHAPE for scans that are none or far away, in another unit perhaps;
        INCONSISTENT_ORIENTATION where most normals are against those of the control mesh.
    """
    check_watchers(progress, monitor)
    scan, outward = vertex_array(points, "points"), np.empty((0, 3))
    if normals is not None:
        outward = vertex_array(normals, "normals")
    sides = np.empty(0, np.int64) if triangles is None else _triangles(triangles)
    bound = 0.0 if tolerance is None else positive("tolerance", tolerance)
    strength = 0.0 if weight is None else positive("weight", weight)
    if bound and strength:
        raise fairing_error(
            "BAD_OPTION", "tolerance and weight exclude each other.", cure="Give one."
        )
    if settings.get("pad_size", 0):
        raise fairing_error(
            "BAD_OPTION",
            "A fit has no pads: fixed vertices are points.",
            cure="Leave pad_size out.",
        )
    # without the border of a mesh nothing along the surface fixes a border curve
    border = {"boundary": "free"} if triangles is None else {}
    control = Control(vertices, faces, {**border, **settings, "levels": levels}, symmetry_plane)
    stays, half = fixed_vertices(fixed, control.count), control.half
    if half:
        scan, sides, _ = half.beside(scan, sides, np.arange(0, len(sides) + 1, 3))
        outward = np.concatenate([outward, half.reflected(outward)])
    with control.named():
        found = _native.fit(
            *control.arrays,
            scan,
            outward,
            sides,
            bound,
            strength,
            control.values(stays.astype(np.uint8)),
            control.options,
            monitor or _native.Monitor(),
            progress,
        )
    return Fitted(written_report(_of_half(half, found, len(scan) // 2) if half else found))


def _of_half(half: Half, found: dict[str, Any], count: int) -> dict[str, Any]:
    """Converts the result for the double to the half and the caller's `count` points."""
    faces = half.face_count
    found = half.cut(found)
    own = found["faces_of_points"][:count]
    found["faces_of_points"] = np.where(own < 0, own, own % faces)
    found["distances"] = found["distances"][:count]
    found["outliers"] = found["outliers"][found["outliers"] < count]
    found["too_coarse"] = np.unique(found["too_coarse"] % faces)
    found["coverage"] = found["coverage"][:faces]
    return found


def _triangles(triangles: ArrayLike) -> np.ndarray:
    array = index_array(triangles, "triangles")
    if array.size and (array.ndim != 2 or array.shape[1] != 3):
        raise fairing_error("BAD_SHAPE", f"triangles has shape {array.shape}; it must be (T, 3).")
    return np.ascontiguousarray(array.reshape(-1))
