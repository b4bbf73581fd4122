# SPDX-License-Identifier: GPL-3.0-or-later
"""ease(): control vertices put where the surface is fair, the least bit away from where they are."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, vertex_array
from .errors import fairing_error
from .halves import Half
from .options import native_options
from .watching import Progress, check_watchers


class Eased:
    """A control mesh of n vertices that has been eased.

    vertices: (n, 3) float64, mesh units, the new positions.
    moves: (n,) float64, mesh units, how far each vertex has moved.
    strain_before, strain_after: (n,) float64, mesh units, as Strain.lengths; NaN for vertices that
    the surface does not hold, which stay where they are.
    amount: float without a unit; 0: nothing has moved, or only the worst have.
    noise: float, mesh units: the root mean square length of the scatter that was taken out.
    iterations: int, solves with moved vertices.
    """

    def __init__(self, points: np.ndarray, found: dict[str, Any]):
        count = len(points)
        moves = found["moves"][:count]
        self.vertices = points + moves
        self.moves = np.linalg.norm(moves, axis=1)
        self.strain_before: np.ndarray = found["strain_before"][:count]
        self.strain_after: np.ndarray = found["strain_after"][:count]
        self.amount: float = found["amount"]
        self.noise: float = found["noise"]
        self.iterations: int = found["iterations"]

    def __repr__(self) -> str:
        moved = int(np.count_nonzero(self.moves))
        return f"Eased({moved} of {len(self.moves)} vertices moved, noise {self.noise:.3g})"


def ease(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    tolerance: ArrayLike | None = None,
    most: int | None = None,
    fixed: ArrayLike | None = None,
    symmetry_plane: str | None = None,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **settings: Any,
) -> Eased:
    """Move control vertices of the thin plate so little, and so, that they stop fighting it.

    Minimizes s² |loads|² + |moves|², a low pass: shapes stay, scatter goes. Vertices on borders,
    creases and corners, and those outside a region, stay where they are.

    Parameters
    ----------
    vertices, faces, symmetry_plane, progress, monitor
        As of fair(). Vertices in the symmetry plane stay in it.
    tolerance
        Mesh units: a float or (n,) floats, 0 or more. No vertex moves farther; s is the largest for
        which that is so. None: s by generalized cross-validation (Golub, Heath and Wahba 1979).
    most
        Move so many vertices at most, the most strained first, each to where the surface wants it.
        Not with a tolerance.
    fixed
        (n,) bool: vertices that stay where they are; loads on them do not count.
    settings
        Those of fair(), but for shapes. The thin plate on pads, through all its control vertices.

    Raises
    ------
    FairingError
        As strain(); BAD_OPTION for bounds that are no lengths, and for a mesh to be mended.
    """
    check_watchers(progress, monitor)
    points = vertex_array(vertices)
    corners, offsets = face_arrays(faces)
    count = len(points)
    bounds, stays = _bounds(tolerance, count), _fixed(fixed, count)
    chosen = _most(most, tolerance)
    given, half, axis = points, None, 0
    if symmetry_plane is not None:
        repair = native_options(**settings).repair
        half = Half(points, corners, offsets, symmetry_plane, repair)
        if chosen:
            raise fairing_error(
                "BAD_OPTION", "most counts single vertices; it goes without symmetry_plane."
            )
        axis = half.axis
        points, settings = half.points(points), half.settings(settings)
        corners, offsets = half.faces(corners, offsets)
        bounds, stays = half.values(bounds), half.values(stays)
    options = native_options(**settings)
    with half.named() if half else nullcontext():
        found = _native.ease(
            points,
            corners,
            offsets,
            bounds,
            chosen,
            stays,
            options,
            monitor or _native.Monitor(),
            progress,
        )
    if half:
        found["moves"][half.in_plane, axis] = 0.0
    return Eased(given, found)


def _bounds(tolerance: ArrayLike | None, count: int) -> np.ndarray:
    if tolerance is None:
        return np.empty(0)
    bounds = np.asarray(tolerance, dtype=np.float64)
    if bounds.shape not in ((), (count,)) or not np.all(bounds >= 0):
        raise fairing_error(
            "BAD_OPTION", f"tolerance must be a length, or {count} of them, and not below 0."
        )
    return np.ascontiguousarray(np.broadcast_to(bounds, (count,)))


def _fixed(fixed: ArrayLike | None, count: int) -> np.ndarray:
    if fixed is None:
        return np.empty(0, dtype=np.uint8)
    stays = np.asarray(fixed)
    if stays.shape != (count,) or stays.dtype != bool:
        raise fairing_error("BAD_OPTION", f"fixed must be {count} bools, one a vertex.")
    return stays.astype(np.uint8)


def _most(most: int | None, tolerance: ArrayLike | None) -> int:
    if most is None:
        return 0
    if tolerance is not None:
        raise fairing_error(
            "BAD_OPTION", "most and tolerance exclude each other. Give one of them."
        )
    if isinstance(most, bool) or not isinstance(most, (int, np.integer)) or most < 1:
        raise fairing_error("BAD_OPTION", f"most is {most!r}; it must be an integer from 1 on.")
    return min(int(most), 2**31 - 1)
