# SPDX-License-Identifier: GPL-3.0-or-later
"""ease(): moves control vertices as little as possible so that the surface becomes fair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import fixed_vertices, vertex_array
from .converters import size, whole
from .errors import fairing_error
from .halves import Control
from .options import CommonSettings
from .watching import Progress, check_watchers


class Eased:
    """A control mesh of n vertices that has been eased.

    vertices: (n, 3) float64, mesh units, the new positions.
    moves: (n,) float64, mesh units, how far each vertex has moved.
    strain_before, strain_after: (n,) float64, mesh units, as Strain.excess; NaN at corners and
    outside a region, where vertices stay.
    floor, wrong: of strain_before, as of Strain.
    amount: float without a unit, the strength of easing; 0 with `most`.
    noise: float, mesh units: an estimate of the scatter, the root mean square distance of a vertex
    from where it belongs; 0 with `most`.
    iterations: int, solves of the surface, all in all.
    """

    def __init__(self, points: np.ndarray, found: dict[str, Any]):
        count = len(points)
        moves = found["moves"][:count]
        self.vertices = points + moves
        self.moves = np.linalg.norm(moves, axis=1)
        self.strain_before: np.ndarray = found["strain_before"][:count]
        self.strain_after: np.ndarray = found["strain_after"][:count]
        self.floor: float = found["floor"]
        self.wrong: np.ndarray = _worst_first(self.strain_before, found["wrong"][:count])
        self.amount: float = found["amount"]
        self.noise: float = found["noise"]
        self.iterations: int = found["iterations"]

    def __repr__(self) -> str:
        moved = int(np.count_nonzero(self.moves))
        return f"Eased({moved} of {len(self.moves)} vertices moved, noise {self.noise:.3g})"


def _worst_first(strain: np.ndarray, wrong: np.ndarray) -> np.ndarray:
    ids = np.flatnonzero(wrong)
    return ids[np.argsort(-np.abs(strain[ids]), kind="stable")]


def ease(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    tolerance: ArrayLike | None = None,
    most: int | None = None,
    fixed: ArrayLike | None = None,
    amount: float | None = None,
    levels: int = 3,
    normals: ArrayLike | None = None,
    symmetry_plane: str | None = None,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **settings: Unpack[CommonSettings],
) -> Eased:
    """Move control vertices of the thin plate so little, and so, that they stop fighting it.

    Minimizes amount² ‖loads‖² + ‖moves‖², a low pass: shapes stay, scatter goes. Vertices on borders
    and creases move along their curves' planes, towards a curve without jumps of its third
    derivative. Corners, ends of curves, straight borders and what is outside a region stay.

    Parameters
    ----------
    vertices, faces, levels, normals, symmetry_plane, progress, monitor
        As of fair(). Levels above the second change nothing; vertices in the symmetry plane stay in it.
    tolerance
        Mesh units: a float or (n,) floats, 0 or more. No vertex moves farther: those that would
        stop at their bound, and the others make the best of that. The amount is as without one; where
        that is 0, the largest whose moves stay within.
    most
        Move so many vertices at most, the most strained first, each to where the surface wants it;
        mirror images of a mesh that is its own move together and count as one. Not with a tolerance.
    fixed
        (n,) bool: vertices that stay where they are; loads on them do not count.
    amount
        0 or more, without a unit: how much to ease; 1 takes half of what scatters from one vertex to
        the next. None: by robust generalized cross-validation (Lukas 2006).
    settings
        Those of fair(), for the thin plate on pads, through all its control vertices.

    Raises
    ------
    FairingError
        As strain(); BAD_OPTION for bounds that are no lengths; TOO_LARGE where memory_limit does
        not hold the matrix of loads, some 3 kB a vertex.
    """
    check_watchers(progress, monitor)
    start = vertex_array(vertices)
    bounds, stays = _bounds(tolerance, len(start)), fixed_vertices(fixed, len(start))
    strength = -1.0 if amount is None else min(size("amount", amount), 1e6)
    count = 0 if most is None else whole("most", most)
    for name, value in (("tolerance", tolerance), ("amount", amount)):
        if most is not None and value is not None:
            raise fairing_error(
                "BAD_OPTION", f"most and {name} exclude each other.", cure="Give one."
            )
    if most is not None and not count:
        raise fairing_error("BAD_OPTION", "most is 0; it must be 1 or more.")
    given: dict[str, Any] = {**settings, "levels": levels, "normals": normals}
    control = Control(start, faces, given, symmetry_plane)
    with control.named():
        found = _native.ease(
            *control.arrays,
            control.values(bounds),
            strength,
            count,
            control.values(stays.astype(np.uint8)),
            control.options,
            monitor or _native.Monitor(),
            progress,
        )
    if control.half:
        found["moves"][control.half.in_plane, control.half.axis] = 0.0
    return Eased(start, found)


def _bounds(tolerance: ArrayLike | None, count: int) -> np.ndarray:
    if tolerance is None:
        return np.empty(0)
    bounds = np.asarray(tolerance, dtype=np.float64)
    if bounds.shape not in ((), (count,)) or not np.all(bounds >= 0):
        raise fairing_error(
            "BAD_OPTION", f"tolerance must be a length, or {count} of them, and not below 0."
        )
    return np.ascontiguousarray(np.broadcast_to(bounds, (count,)))
