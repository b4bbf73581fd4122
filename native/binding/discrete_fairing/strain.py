# SPDX-License-Identifier: GPL-3.0-or-later
"""strain(): finds control vertices that spoil the surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .halves import Control
from .options import AllSettings
from .watching import Progress, check_watchers

# Root mean square strain, away from curves, caused by unit scatter: 1.31 to 1.40 on grids of quads and of
# triangles with 9 x 9 and 21 x 21 vertices; times the standard deviation over the median of its size.
OF_SCATTER, OF_MEDIAN = 1.35, 1.4826


class Strain:
    """How far the surface would move at each of n control vertices if that vertex were released.

    lengths: (n,) float64, mesh units, along the control mesh's normal, positive outwards. On curves
    the whole length, of the curve alone, positive on the normal's side. NaN at corners, at and next
    to ends of curves, and outside a region.
    ways: (n, 3) float64, mesh units: the same as vectors, with the part along the surface.
    excess, excess_ways: (n,), (n, 3) float64, mesh units: each vertex' own part, without the effect
    of borders, at which a plate ends without a moment, and, the most strained vertex first, without
    the effect of worse neighbours above the floor.
    floor: float, mesh units: the excess that scatter explains, three standard deviations estimated by
    the median.
    wrong: (k,) int64, the vertices whose excess is above the floor and above three deviations of
    their surroundings, the worst first. A grossly wrong vertex is corrected first, and the others are
    measured without it.
    noise: float, mesh units: the scatter along the normal, estimated from the median strain off
    curves. It includes the strain of the shape itself; df.ease() separates the two.
    """

    def __init__(self, found: dict[str, Any], count: int):
        self.lengths: np.ndarray = found["lengths"][:count]
        self.ways: np.ndarray = found["ways"][:count]
        self.excess: np.ndarray = found["excess"][:count]
        self.excess_ways: np.ndarray = found["excess_ways"][:count]
        self.floor: float = found["floor"]
        self._is_wrong = found["wrong"][:count] > 0
        lengths, on_curve = self.lengths, found["on_curve"][:count]
        sizes = np.abs(lengths[~np.isnan(lengths) & (on_curve == 0)])
        self.noise = float(OF_MEDIAN / OF_SCATTER * np.median(sizes)) if len(sizes) else 0.0

    def worst(self, count: int = 10) -> np.ndarray:
        """(k,) int64: at most `count` vertices with the largest excess, the largest first."""
        sizes = np.where(np.isnan(self.excess), -1.0, np.abs(self.excess))
        order = np.argsort(-sizes, kind="stable")[:count]
        return order[sizes[order] >= 0]

    @property
    def wrong(self) -> np.ndarray:
        worst = self.worst(len(self.excess))
        return worst[self._is_wrong[worst]]

    def __repr__(self) -> str:
        worst = self.worst(1)
        largest = f", {self.excess[worst[0]]:.3g} at vertex {worst[0]}" if len(worst) else ""
        return f"Strain({len(self.lengths)} vertices{largest})"


def strain(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    symmetry_plane: str | None = None,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **settings: Unpack[AllSettings],
) -> Strain:
    """Find control vertices that spoil the thin plate's surface, such as wrong offsets.

    A misplaced vertex is held by a load. Divided by the load of a unit move of this vertex alone, it
    is the distance by which the surface would move there if the vertex were released.

    Parameters
    ----------
    vertices, faces, symmetry_plane, progress, monitor
        As of fair().
    settings
        Those of fair() except shapes. For the thin plate on pads, through all its control vertices;
        levels above 2 make no difference.

    Raises
    ------
    FairingError
        As fair(); BAD_OPTION for other energies, control vertices that move, and point forces.
    """
    check_watchers(progress, monitor)
    control = Control(vertices, faces, dict(settings), symmetry_plane)
    return strain_of(control, control.options, monitor or _native.Monitor(), progress)


def strain_of(
    control: Control,
    options: _native.Options,
    monitor: _native.Monitor,
    progress: Progress | None = None,
) -> Strain:
    """strain() of a control mesh that has been read."""
    with control.named():
        found = _native.strain(*control.arrays, options, monitor, progress)
    return Strain(found, control.count)
