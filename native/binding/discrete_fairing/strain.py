# SPDX-License-Identifier: GPL-3.0-or-later
"""strain(): which control vertices fight the surface, and by how much."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, vertex_array
from .halves import Half
from .options import native_options
from .watching import Progress, check_watchers


class Strain:
    """How far the surface would spring away at each of n control vertices, were that one let go.

    lengths: (n,) float64, mesh units, along the control mesh's normal: above zero outwards. On
    curves the whole way, of the curve by itself: above zero on the normal's side. NaN at corners,
    at and next to ends of curves, and outside a region.
    ways: (n, 3) float64, mesh units: the whole of each way, along the surface too.
    """

    def __init__(self, lengths: np.ndarray, ways: np.ndarray):
        self.lengths = lengths
        self.ways = ways

    def worst(self, count: int = 10) -> np.ndarray:
        """(k,) int64: the vertices of the largest strain, the largest first; at most `count`."""
        sizes = np.where(np.isnan(self.lengths), -1.0, np.abs(self.lengths))
        order = np.argsort(-sizes, kind="stable")[:count]
        return order[sizes[order] >= 0]

    def __repr__(self) -> str:
        worst = self.worst(1)
        largest = f", {self.lengths[worst[0]]:.3g} at vertex {worst[0]}" if len(worst) else ""
        return f"Strain({len(self.lengths)} vertices{largest})"


def strain(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    symmetry_plane: str | None = None,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **settings: Any,
) -> Strain:
    """Which control vertices spoil the thin plate's surface: measured offsets that are wrong.

    A vertex that is in its neighbours' way is held by a load. Over the load that a unit's move of
    this vertex alone would ask for, that is the way by which the surface would spring there.

    Parameters
    ----------
    vertices, faces, symmetry_plane, progress, monitor
        As of fair().
    settings
        Those of fair(), but for shapes. The thin plate on pads, through all its control vertices;
        levels above the second change nothing.

    Raises
    ------
    FairingError
        As fair(); BAD_OPTION for other energies, control vertices that move, and point forces.
    """
    check_watchers(progress, monitor)
    points = vertex_array(vertices)
    corners, offsets = face_arrays(faces)
    count, half = len(points), None
    if symmetry_plane is not None:
        repair = native_options(**settings).repair
        half = Half(points, corners, offsets, symmetry_plane, repair)
        points, settings = half.points(points), half.settings(settings)
        corners, offsets = half.faces(corners, offsets)
    options = native_options(**settings)
    with half.named() if half else nullcontext():
        found = _native.strain(
            points, corners, offsets, options, monitor or _native.Monitor(), progress
        )
    return Strain(found["lengths"][:count], found["ways"][:count])
