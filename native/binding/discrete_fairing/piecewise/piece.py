# SPDX-License-Identifier: GPL-3.0-or-later
"""A piece of a control mesh, which can be faired alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _native
from ..options import native_options
from ..watching import Progress, check_watchers
from .numbering import ControlFaces
from .outline import Outline
from .part import Part, report_of


@dataclass(frozen=True, eq=False, repr=False)
class Piece:
    """Some faces of a control mesh with rings around them, as pieces() cuts them out.

    Can be pickled. It needs nothing but itself: fair() gives what it owns of the surface. All arrays are
    of the size of its control mesh, but for the points of curves.

    index: which piece, from 0.
    vertices: (v, 3) float64, shapes: (k, v, 3); corners and offsets: its faces, as fair() takes them.
    settings: of fair(), with the piece's own ids.
    of_whole: what a piece cannot know, curves and units.
    vertex_id: (v,), its vertices' ids in the whole.
    control: its control faces in the whole. owned: (F,), corner_owned, side_owned: (F, 4), bool: whether it
    owns a face, and the points at its corners and inside its sides.
    surface: what all parts agree on.
    """

    index: int
    vertices: np.ndarray
    shapes: np.ndarray
    corners: np.ndarray
    offsets: np.ndarray
    settings: dict[str, Any]
    of_whole: dict[str, Any]
    vertex_id: np.ndarray
    control: ControlFaces
    owned: np.ndarray
    corner_owned: np.ndarray
    side_owned: np.ndarray
    surface: dict[str, Any]

    def fair(
        self,
        *,
        threads: int = 0,
        memory_limit: int = 0,
        progress: Progress | None = None,
        monitor: _native.Monitor | None = None,
    ) -> Part:
        """The part of the surface that this piece owns.

        The arguments are fair()'s. The result is the same, to the last bit, on any machine and for
        any number of threads. Raises FairingError as fair() does, with ids of the piece.
        """
        check_watchers(progress, monitor)
        settings = dict(self.settings, threads=threads, memory_limit=memory_limit)
        region = settings.get("region")
        is_outside = region is not None and not len(region)
        if is_outside:
            del settings["region"]
        options = native_options(settings)
        own = Outline(self.vertices, self.corners, self.offsets, self.shapes, options)
        if is_outside:
            control = zip((self.vertices, *self.shapes), own.centres)
            surfaces = [linear_surface(own, np.concatenate(held)) for held in control]
            report = None
        else:
            found = _native.fair(
                self.vertices,
                self.corners,
                self.offsets,
                self.shapes,
                options,
                monitor or _native.Monitor(),
                progress,
                self.of_whole,
            )
            surfaces, report = [found["vertices"], *found["shapes"]], found["report"]
            del found
        return self._part(own, surfaces, report)

    def _part(
        self, own: Outline, surfaces: list[np.ndarray], report: dict[str, Any] | None
    ) -> Part:
        """The owned part of `surfaces`, of the mesh and then of each shape."""
        mine = np.flatnonzero(self.owned)
        both = self._points(own, mine, False), self._points(own, mine, True)
        ids, rows, owned = (np.concatenate(arrays) for arrays in zip(*both))
        shared, beside = np.unique(ids[~owned], return_index=True)
        ids, first = np.unique(ids[owned], return_index=True)
        points, *shapes = [surface[rows[owned][first]] for surface in surfaces]
        count = np.searchsorted(ids, self.surface["input_vertices"])
        return Part(
            index=self.index,
            surface=self.surface,
            ids=ids,
            vertices=points,
            shapes=shapes,
            seam_ids=shared,
            seam_points=surfaces[0][rows[~owned][beside]],
            control=self.control.take(mine),
            report=report_of(self, report, ids[:count], [p[:count] for p in (points, *shapes)]),
        )

    def _points(
        self, own: Outline, mine: np.ndarray, quad: bool
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of all points of the triangles, or of the quads, among the faces `mine`: ids in the whole, rows in
        the piece, and whether the piece owns them.
        """
        mine = mine[self.control.quad[mine] == quad]
        there = self.control.take(mine).points(self.surface["numbering"], quad)
        here = own.control.take(mine).points(own.numbering, quad)
        lattice = own.numbering.lattice(quad)
        mirrored = self._mirrored(own)[mine]
        here[mirrored] = here[mirrored][:, lattice.at(lattice.j, lattice.i)]
        owned = np.zeros(there.shape, bool)
        owned[:, lattice.interior] = True
        owned[:, lattice.corners] = self.corner_owned[mine, : lattice.size]
        for s in range(lattice.size):
            owned[:, lattice.sides[s]] = self.side_owned[mine, s, None]
        return there.ravel(), here.ravel(), owned.ravel()

    def _mirrored(self, own: Outline) -> np.ndarray:
        """(F,) bool: faces that are reversed in this piece, as on one-sided sheets."""
        ids = np.full(own.numbering.vertices + 1, -1, np.int64)  # the last one is for no vertex
        ids[: len(self.vertex_id)] = self.vertex_id
        here = ids[own.control.vertex]
        face = self.control.vertex
        there = np.where(np.isin(face, self.vertex_id), face, -1)
        if here.shape != there.shape:
            raise RuntimeError("The piece's polygons are split differently from the whole's.")
        orders = np.array([[0, 2, 1, 3], [0, 3, 2, 1]])  # of reversed faces; the first corner stays
        turned = np.take_along_axis(here, orders[self.control.quad.astype(int)], axis=1)
        mirrored = (here != there).any(axis=1)
        if (turned[mirrored] != there[mirrored]).any():
            raise RuntimeError("The piece's faces are numbered differently from the whole's.")
        return mirrored

    def __repr__(self) -> str:
        return (
            f"Piece({self.index} of {self.surface['count']}, {int(self.owned.sum())} control faces "
            f"and {int((~self.owned).sum())} around them)"
        )


def linear_surface(own: Outline, control: np.ndarray) -> np.ndarray:
    """(N, 3): a piece's linear surface outside the region; `control`: its vertices and centres."""
    points = np.empty((own.numbering.size, 3))
    for quad in (False, True):
        weights = own.numbering.lattice(quad).weights
        corner = own.control.vertex[own.control.quad == quad, : weights.shape[1]]
        ids = own.control.points(own.numbering, quad)
        points[ids] = np.einsum("pc,fca->fpa", weights, control[corner])
    points[: len(control)] = control
    return points
