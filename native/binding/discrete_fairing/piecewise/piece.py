# SPDX-License-Identifier: GPL-3.0-or-later
"""A piece of a control mesh, which can be faired alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _native
from ..options import native_options
from ..watching import Progress, check_watchers
from .numbering import closed_ids
from .outline import Outline
from .part import Part, report_of


@dataclass(frozen=True, eq=False, repr=False)
class Piece:
    """Some faces of a control mesh with rings around them, as pieces() cuts them out.

    Can be pickled. It needs nothing but itself: fair() gives what it owns of the surface. All arrays are of the size of its control mesh, but for the points of curves.

    index: which piece, from 0.
    vertices: (v, 3) float64, shapes: (k, v, 3); corners and offsets: its faces, as fair() takes them.
    settings: of fair(), with the piece's own ids.
    of_whole: what a piece cannot know, curves and units.
    vertex_id: (v,), its vertices' ids in the whole.
    face, side_edge, side_reversed: (F, 4), face_id, quads_before, polygon, owned: (F,),
    corner_owned, side_owned: (F, 4): its control faces in the whole (outline.py), and what it owns.
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
    face: np.ndarray
    side_edge: np.ndarray
    side_reversed: np.ndarray
    face_id: np.ndarray
    quads_before: np.ndarray
    polygon: np.ndarray
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
        mirrored = self._mirrored(own)
        mine, quad = np.flatnonzero(self.owned), self.face[:, 3] >= 0
        vertex_id, vertex_row = self._vertices(own, mirrored, self.corner_owned)
        edge_id, edge_rows = self._edges(own, mirrored, self.side_owned)
        there = self.owned[:, None] & (self.face >= 0)
        seam_vertex_id, seam_vertex_row = self._vertices(own, mirrored, there & ~self.corner_owned)
        seam_edge_id, seam_edge_rows = self._edges(own, mirrored, there & ~self.side_owned)
        inside = [
            self._interiors(own, mirrored, np.flatnonzero(self.owned & (quad == kind)), kind)
            for kind in (False, True)
        ]

        def owned_of(points: np.ndarray) -> dict[str, np.ndarray]:
            return {
                "vertex_points": points[vertex_row],
                "edge_points": points[edge_rows],
                "triangle_points": points[inside[0]],
                "quad_points": points[inside[1]],
                "seam_vertex_points": points[seam_vertex_row],
                "seam_edge_points": points[seam_edge_rows],
            }

        points, *shapes = surfaces
        return Part(
            index=self.index,
            surface=self.surface,
            vertex_id=vertex_id,
            edge_id=edge_id,
            face=self.face[mine],
            side_edge=self.side_edge[mine],
            side_reversed=self.side_reversed[mine],
            face_id=self.face_id[mine],
            quads_before=self.quads_before[mine],
            polygon=self.polygon[mine],
            seam_vertex_id=seam_vertex_id,
            seam_edge_id=seam_edge_id,
            shapes={str(s): owned_of(shape) for s, shape in enumerate(shapes)},
            report=report_of(
                self, report, vertex_id, [surface[vertex_row] for surface in surfaces]
            ),
            **owned_of(points),
        )

    def _mirrored(self, own: Outline) -> np.ndarray:
        """(F,) bool: faces that are reversed in this piece, as on one-sided sheets."""
        ids = np.full(own.numbering.vertices + 1, -1, np.int64)  # the last one is for no vertex
        ids[: len(self.vertex_id)] = self.vertex_id
        here = ids[own.face]
        there = np.where(np.isin(self.face, self.vertex_id), self.face, -1)
        if here.shape != there.shape:
            raise RuntimeError("The piece's polygons are split differently from the whole's.")
        size = 3 + (self.face[:, 3] >= 0)
        turned = here[np.arange(len(here))[:, None], turned_corners(size)]
        mirrored = (here != there).any(axis=1)
        if (turned[mirrored] != there[mirrored]).any():
            raise RuntimeError("The piece's faces are numbered differently from the whole's.")
        return mirrored

    def _vertices(
        self, own: Outline, mirrored: np.ndarray, which: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Ids in the whole and rows in the piece of the vertices at these corners (F, 4), each once."""
        ids, face, corner = _once(self.face, which)
        size = 3 + (self.face[:, 3] >= 0)
        turned = turned_corners(size)[face, corner]
        return ids, own.face[face, np.where(mirrored[face], turned, corner)]

    def _edges(
        self, own: Outline, mirrored: np.ndarray, which: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Ids in the whole (e,) and rows in the piece (e, n - 1) of the edges at these sides."""
        ids, face, side = _once(self.side_edge, which)
        turned = 2 + (self.face[face, 3] >= 0) - side
        place = np.where(mirrored[face], turned, side)
        along = own.side_reversed[face, place] ^ mirrored[face]
        against = along.astype(bool) != self.side_reversed[face, side].astype(bool)
        k = np.arange(own.numbering.n - 1)
        k = np.where(against[:, None], k[::-1], k)
        return ids, own.numbering.edge_bases(own.side_edge[face, place])[:, None] + k

    def _interiors(
        self, own: Outline, mirrored: np.ndarray, faces: np.ndarray, quad: bool
    ) -> np.ndarray:
        """(f, interior): rows of the points inside these faces, all quads or all triangles."""
        lattice = own.numbering.lattice(quad)
        base = own.numbering.face_bases(faces, own.quads_before[faces])
        rows = base[:, None] + np.arange(lattice.interior_count)
        turn = mirrored[faces]
        if turn.any():
            rows[turn] = base[turn, None] + lattice.mirrored
        return rows

    def __repr__(self) -> str:
        return (
            f"Piece({self.index} of {self.surface['count']}, {int(self.owned.sum())} control faces "
            f"and {int((~self.owned).sum())} around them)"
        )


def _once(ids: np.ndarray, which: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ids (F, 4) that are chosen, ascending, each once, with the row and column of its first place."""
    row, column = np.nonzero(which)
    found, first = np.unique(ids[row, column], return_index=True)
    return found, row[first], column[first]


def turned_corners(size: np.ndarray) -> np.ndarray:
    """(F, 4): the corners of reversed faces, in the order of the original ones; the first one stays."""
    rows = np.array([[0, 2, 1, 3], [0, 3, 2, 1]])
    return rows[size - 3]


def linear_surface(own: Outline, control: np.ndarray) -> np.ndarray:
    """(N, 3): a piece's linear surface outside the region; `control`: its vertices and centres."""
    numbering = own.numbering
    points = np.empty((numbering.size, 3))
    for kind in (False, True):
        faces = np.flatnonzero(own.quad == kind)
        lattice = numbering.lattice(kind)
        k = lattice.size
        base = numbering.face_bases(faces, own.quads_before[faces])
        corner = own.face[faces, :k]
        ids = closed_ids(
            numbering, corner, own.side_edge[faces, :k], own.side_reversed[faces, :k], base, lattice
        )
        points[ids] = np.einsum("pc,fca->fpa", lattice.weights(), control[corner])
    points[: len(control)] = control
    return points
