# SPDX-License-Identifier: GPL-3.0-or-later
"""fit_patches(): spline patches of the fair surface of a control mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import face_arrays, vertex_array
from ..checking import predicted_size
from ..converters import switch, whole
from ..fairing import fair
from ..options import CommonSettings
from ..result import Result
from ..scan_fitting import Fitted
from ..watching import Progress, SeveralRuns, check_watchers
from .distances import distances_from
from .finer_fits import FinerFits
from .fits import PatchFits
from .levels import at_level, at_own_level
from .patches import SplinePatches


class PatchSettings(CommonSettings, total=False):
    """The settings of fit_patches() beside its own: those of fair()."""

    energy: str
    normals: ArrayLike | None
    symmetry_plane: str | None
    neighbour: tuple[ArrayLike, Any] | None
    border: ArrayLike | None
    halfway: bool
    shapes: ArrayLike | Sequence[ArrayLike] | None


def fit_patches(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    tolerance: float | None = None,
    normal_tolerance: float | None = None,
    levels: int | None = None,
    force: bool = False,
    fair_tolerance: float | ArrayLike | None = None,
    scan: Mapping[str, Any] | None = None,
    blend: Callable[[Result, int], np.ndarray] | None = None,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **settings: Unpack[PatchSettings],
) -> SplinePatches:
    """Bicubic B-spline patches of a control mesh's fair surface, ready for CAD (write_step).

    Parameters
    ----------
    vertices, faces
        As those of fair().
    tolerance : float, share of the size
        The farthest that a patch may be from the fair surface: from the refined one, and about that
        from the limit of finer ones, together; the size is the largest extent along an axis. None: a
        ten-thousandth; with a scan half of the distance of 95 % of its points, if that is more.
    normal_tolerance : float, radians
        The sharpest angle between the normals of two patches along an edge that is no crease. None:
        8e-4; with a scan the angle of `tolerance` over a mean control edge, if that is more.
    levels : int
        How often the mesh is refined before patches are fitted. None: 5, or more where a tolerance
        asks for it, the surface stays below 300 000 points, or 1 200 000 where faces miss the
        tolerance, and the largest miss may halve; less for very large meshes.
    force : bool
        Return patches also where the refined surface folds or is not resolved. Their input faces
        are in patches.unresolved then.
    fair_tolerance : float or (n,) float, mesh units
        fair()'s own tolerance, with interpolation="approximate".
    scan : dict
        Arguments of fit(), points at least, with its `levels`, 2 by default and 4 at most: patches of
        the surface near that scan, which finer ones pass through, and patches.scan_distances.
    blend : callable (Result, level) -> (N, 3) float64
        What patches are fitted to in place of the result's vertices, such as a mix of them with its
        shapes. Called for each surface, at each level; patches.result has the outcome.
    groups : (f,) int
        Faces of different numbers, such as materials, are in different patches.
    progress, monitor, **settings
        As those of fair(): energy, creases, boundary and so on.

    Returns
    -------
    SplinePatches
        Where a tolerance could not be met, patches.unmet has the input faces.

    Raises
    ------
    FairingError
        As fair() does. UNRESOLVED where the refined surface folds, or turns by more than 20 degrees
        between two of its faces; `elements` are the input faces there.
    """
    fits = PatchFits(tolerance, normal_tolerance, switch("force", force))
    check_watchers(progress, monitor)
    options: dict[str, Any] = dict(settings)
    if fair_tolerance is not None:
        options["tolerance"] = fair_tolerance
    runs = SeveralRuns(progress, monitor, whole("threads", options.pop("threads", 0)))
    points = vertex_array(vertices)
    polygons = face_arrays(faces)
    if groups is not None:
        fits.keep_apart(groups, len(polygons[1]) - 1)
    near = None if scan is None else FinerFits(points, polygons, scan, options)

    def surface(level: int, **watchers: Any) -> Result:
        if near is None:
            result = fair(points, polygons, level, **options, **watchers)
        else:
            result = near.at(level, **watchers)
            fits.allow_for(near.fit, polygons)
        if blend is not None:
            result.vertices = np.ascontiguousarray(blend(result, level), np.float64)
        return result

    def count(level: int) -> int:
        halves = 1 if options.get("symmetry_plane") is None else 2
        energy = options.get("energy", "thin_plate")
        return halves * predicted_size(len(points), polygons, level, energy=energy)["vertices"]

    # the first surface is that of the fit itself, or finer
    coarser = 2 if near is None else 1
    if levels is None:
        found = at_own_level(fits, surface, count, runs, coarser)
    else:
        found = at_level(fits, surface, whole("levels", levels), runs, coarser)
    runs.finish()
    if scan is not None and isinstance(found.result, Fitted):
        off = _on_one_side(np.asarray(scan["points"], np.float64), found.result, options)
        found.scan_distances = distances_from(found, off, found.result.faces_of_points)
    return found


def _on_one_side(points: np.ndarray, half: Result, options: Mapping[str, Any]) -> np.ndarray:
    """The points of a scan; with a symmetry_plane, mirrored to the side of `half`."""
    if options.get("symmetry_plane") is None:
        return points
    axis = "xyz".index(options["symmetry_plane"])
    points = points.copy()
    points[:, axis] = np.copysign(points[:, axis], half.vertices[:, axis].sum())
    return points
