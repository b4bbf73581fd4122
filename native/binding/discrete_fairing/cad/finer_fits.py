# SPDX-License-Identifier: GPL-3.0-or-later
"""Finer surfaces through the points of a fit: nothing sharper appears between them than the fit has."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from typing import Any

import numpy as np

from ..arrays import joined_faces
from ..converters import whole
from ..fairing import fair
from ..lattice import Lattice, fine_edges
from ..options import FACE_IDS
from ..result import Result
from ..scan_fitting import Fitted, fit

# settings of the control mesh's edges, or met by the fit
_SETTLED = {"crease_edges", "crease_angle", "boundary_edges", "soft_creases", "tension"}
_SETTLED |= {"repair", "weld"}


class FinerFits:
    """The surface near a scan, and thin plates through all its points. It is fitted when first asked for."""

    def __init__(
        self,
        points: np.ndarray,
        polygons: tuple[np.ndarray, np.ndarray],
        scan: Mapping[str, Any],
        settings: Mapping[str, Any],
    ):
        """`scan`: arguments of fit(); its `levels`, 2 by default, are those of the surface itself.
        `settings`: of fair().
        """
        self._mesh, self._settings = (points, polygons), dict(settings)
        self._scan = dict(scan)
        self._levels = whole("levels", self._scan.pop("levels", 2))
        self._through: dict[str, Any] = {}  # settings of the plates

    def at(self, levels: int, **watchers: Any) -> Fitted:
        """The surface of `levels`, with the points and faces of a fit; the rest is known of the fit."""
        if not self._through:
            self._levels = min(self._levels, levels)
            points, polygons = self._mesh
            given = {**self._scan, **self._settings, **watchers}
            self.fit = fit(points, polygons, levels=self._levels, **given)
            self._through = self._settings_through()
        finer = levels - self._levels
        if not finer:
            return self.fit
        made = fair(
            self.fit.vertices, joined_faces(self.fit.faces), finer, **self._through, **watchers
        )
        out = copy(self.fit)
        vars(out).pop("triangles", None)  # kept from an earlier use
        out.vertices, out.faces = made.vertices, self._in_order(made, finer)
        out.triangle_polygon, out.quad_polygon = (
            np.repeat(of, 4**finer) for of in (out.triangle_polygon, out.quad_polygon)
        )
        return out

    def _in_order(self, made: Result, finer: int) -> tuple[np.ndarray, np.ndarray]:
        """The faces of `made`, as if the control mesh had been refined by all levels at once."""
        triangles, quads = self.fit.faces
        refined = [
            _Refined(faces, of[:: 4**finer], finer)
            for faces, of in zip(made.faces, (made.triangle_polygon, made.quad_polygon))
        ]
        own = _joined(triangles, 0, self._levels, refined)
        return own, _joined(quads, len(triangles), self._levels, refined)

    def _settings_through(self) -> dict[str, Any]:
        given = self._settings
        own: dict[str, Any] = {} if "triangles" in self._scan else {"boundary": "free"}
        own |= {name: given[name] for name in given if name not in {*FACE_IDS, *_SETTLED}}
        polygons = np.concatenate([self.fit.triangle_polygon, self.fit.quad_polygon])
        for name in FACE_IDS:
            if given.get(name) is not None:
                own[name] = np.flatnonzero(np.isin(polygons, given[name]))
        own["crease_edges"] = self._divided(self.fit.crease_edges)
        kinds = given.get("boundary_edges") or {}
        own["boundary_edges"] = {kind: self._divided(pairs) for kind, pairs in kinds.items()}
        return own | {"measure": False}

    def _divided(self, edges: Any) -> np.ndarray:
        """(k, 2): control edges, as pairs of vertices, divided."""
        found = fine_edges(self.fit.faces, np.asarray(edges, np.int64), self._levels)
        return np.unique(np.sort(found, axis=1), axis=0)


class _Refined:
    """Faces refined by some levels: their corners, all their points, and which of the given faces
    each is, or is a half of.
    """

    def __init__(self, faces: np.ndarray, of: np.ndarray, levels: int):
        self.of, self.lattice = of, Lattice(2**levels, faces.shape[1] == 4)
        self.points = self.lattice.closed(faces)
        self.corners = self.points[:, self.lattice.corners]


def _joined(faces: np.ndarray, first: int, levels: int, refined: list[_Refined]) -> np.ndarray:
    """`faces` of so many levels, numbered from `first` on, after they were refined further. Quads that
    are far from convex were cut into triangles for that, whose points are those of the quad.
    """
    coarse = Lattice(2**levels, faces.shape[1] == 4)
    finer = refined[0].lattice.n
    both = Lattice(coarse.n * finer, coarse.quad)
    corners = finer * np.stack([coarse.i, coarse.j], 1)[coarse.cells]  # (cells, size, 2)
    points = np.empty((len(faces) // len(coarse.cells), len(both.i)), faces.dtype)
    for part in refined:
        own = np.flatnonzero((part.of >= first) & (part.of < first + len(faces)))
        face, cell = np.divmod(part.of[own] - first, len(coarse.cells))
        given = faces[part.of[own] - first]
        which = (given[:, None] == part.corners[own][:, :, None]).argmax(2)
        places = np.rint(part.lattice.weights @ corners[cell[:, None], which]).astype(np.int64)
        points[face[:, None], both.at(*np.moveaxis(places, 2, 0))] = part.points[own]
    return points[:, both.cells].reshape(-1, coarse.size)
