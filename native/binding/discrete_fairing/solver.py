# SPDX-License-Identifier: GPL-3.0-or-later
"""Solver: fairs one control mesh repeatedly while its vertices move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from threading import Lock
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import vertex_array
from .errors import fairing_error, written_report
from .halves import Control
from .joints.matching import MatchedBorder
from .options import Settings
from .result import Result
from .watching import Progress, check_watchers


class Solver:
    """Fairs one control mesh repeatedly while its vertices move.

    Keeps the hierarchy, operators and buffers, and starts each solve from the last surface.

    Parameters
    ----------
    vertices, faces, levels, energy, symmetry_plane, neighbour, border, halfway
        As those of fair(). The neighbour stays as it is at construction.
    **settings
        discrete_fairing.Settings. Without `measure` no energy is measured (NaN in the report).
        method="back_leg" is refused.

    Raises
    ------
    FairingError
        As fair() does.

    The constructor checks and builds; it does not solve. A second call at the same time raises
    FairingError BUSY.
    """

    def __init__(
        self,
        vertices: ArrayLike,
        faces: ArrayLike | Sequence[Sequence[int]],
        levels: int = 3,
        energy: str = "thin_plate",
        *,
        symmetry_plane: str | None = None,
        neighbour: tuple[ArrayLike, Any] | None = None,
        border: ArrayLike | None = None,
        halfway: bool = False,
        **settings: Unpack[Settings],
    ):
        given: dict[str, Any] = {**settings, "levels": levels, "energy": energy}
        control = self._control = Control(vertices, faces, given, symmetry_plane)
        matched = MatchedBorder(control, neighbour, border, halfway) if neighbour else None
        self._matched = matched
        with control.named():
            self._native = _native.Solver(*control.arrays, control.options)
        self._constants = self._native.constants()
        self._busy = Lock()
        self._energy = energy

    @property
    def control_vertices(self) -> int:
        """The number n of control vertices."""
        return self._control.count

    @property
    def levels(self) -> int:
        return self._control.options.levels

    @property
    def energy(self) -> str:
        return self._energy

    @property
    def bytes(self) -> int:
        """Bytes of the long arrays and factorizations that are kept from call to call."""
        return self._native.bytes

    @property
    def vertex_origin(self) -> np.ndarray | None:
        """(n,) int32: the vertex with which each was merged, usually itself; None: none was."""
        mended = self._constants["mended"]
        return mended["vertex_origin"][: self.control_vertices] if mended else None

    def solve(
        self,
        vertices: ArrayLike | None = None,
        *,
        progress: Progress | None = None,
        monitor: _native.Monitor | None = None,
    ) -> Result:
        """The surface through control vertices at these positions (n, 3); None: the last positions.

        Charts, stencils, the curves' parameters and split polygons stay those of the vertices at
        construction, or of the last rebase. The first call's surface is that of fair(), to the last
        bit; later ones start from the last surface and end at the same accuracy. result.vertices is
        new each time; result.faces, triangle_polygon, quad_polygon and crease_edges are the same
        read-only arrays. report["warm"] says whether the last surface was the start.

        Raises FairingError: BAD_SHAPE, NON_FINITE, TOO_EXTREME, CANCELLED, BUSY. The solver can go
        on after any of them. In a forked process: FORKED, always.
        """
        check_watchers(progress, monitor)
        points = np.empty((0, 3)) if vertices is None else self._positions(vertices)
        with self._alone(), self._control.named():
            solved = self._native.solve(points, monitor, progress)
            found = {**self._constants, "shapes": [], **solved}
            if self._matched:
                self._matched.meet(found)
            return Result(written_report(self._control.cut(found)))

    def rebase(self, vertices: ArrayLike) -> None:
        """Recompute charts, stencils and curves from these positions (n, 3).

        Creases chosen by an angle, and the splits of polygons, stay. The next solve starts afresh.
        Raises FairingError as fair() does for bad geometry, and then changes nothing.
        """
        points = self._positions(vertices)
        with self._alone(), self._control.named():
            self._native.rebase(points)

    def _positions(self, vertices: ArrayLike) -> np.ndarray:
        points = vertex_array(vertices)
        if len(points) != self.control_vertices:
            raise fairing_error(
                "BAD_SHAPE",
                f"vertices has shape {points.shape}; it must be ({self.control_vertices}, 3), "
                "as at the start.",
            )
        return self._control.half.points(points) if self._control.half else points

    @contextmanager
    def _alone(self) -> Iterator[None]:
        if not self._busy.acquire(blocking=False):
            self._native.require_own_process()  # a forked process inherits a lock that nobody releases
            raise fairing_error(
                "BUSY",
                "The solver is running another call.",
                cure="Wait for it, or make another solver.",
            )
        try:
            yield
        finally:
            self._busy.release()

    def __repr__(self) -> str:
        return (
            f"Solver({self.control_vertices} control vertices, levels={self.levels}, "
            f"energy={self._energy!r})"
        )
