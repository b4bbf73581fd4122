# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes of a mesh, found and closed by the fairest surface."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, index_array, vertex_array
from .errors import fairing_error
from .fairing import fair
from .options import native_options
from .watching import Progress, SeveralRuns, check_watchers

# A filling is remeshed where fairing has made its area so many times as large: up to there its edges
# are within a tenth of the length wanted, and to fair it twice only costs as much again.
_GROWN = 1.2

# Rings of faces around a hole whose vertices say how the surface goes on.
_RINGS = {"position": 0, "tangent": 1, "curvature": 2}

# The flat filling of half a sphere has half the sphere's area: faired once, it gets new triangles of
# the density wanted, and is faired again.
_ROUNDS = 2

_SHOWN = 8  # ids that a message lists


@dataclass(frozen=True, slots=True)
class FilledHole:
    """What has become of one hole.

    loops: list of (k,) int64
        Its rim, and those of its islands.
    vertices, faces: range
        Ids of the new vertices and faces in `Filled`.
    energy: str
        The energy that was minimized; "none" where no vertex was new.
    converged: bool
        Whether its steps came to their end.
    folds: int
        Edges at which the surface turns back, the rim's included.
    """

    loops: list[np.ndarray]
    vertices: range
    faces: range
    energy: str
    converged: bool
    folds: int


@dataclass(frozen=True, slots=True)
class Filled:
    """A mesh whose holes are closed.

    vertices: (N, 3) float64
        The n old ones first, to the last bit.
    faces: (M, 3) int64, or the pair (corners, offsets) where not all are triangles
        The m old ones first.
    new_faces: (M - m,) int64
        Ids of the new ones, which are triangles.
    holes: list of FilledHole
        What closed each hole, in the order of the holes.
    """

    vertices: np.ndarray
    faces: np.ndarray | tuple[np.ndarray, np.ndarray]
    new_faces: np.ndarray
    holes: list[FilledHole]


def find_holes(vertices: ArrayLike, faces: ArrayLike | Sequence[Sequence[int]]) -> list[np.ndarray]:
    """The holes of a mesh: (k,) int64 vertex ids around each, as a face that fills it runs.

    A walk that touches itself in a vertex is cut there into several loops. The border of an open
    sheet is a loop like others. Loops begin with their least id and come in the order of these. At
    edges of more than two faces, and where neighbours disagree on their orientation, there is no
    telling what a hole is: such walks are left out. Raises FairingError for arrays that make no
    mesh.
    """
    filler = _native.Filler(vertex_array(vertices), *face_arrays(faces))
    return [np.array(loop, np.int64) for loop in filler.find(_native.Monitor(), None)]


def fill_holes(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    holes: Sequence[Any] | None = None,
    joint: str = "curvature",
    energy: str = "total_curvature",
    density: float = 1.0,
    threads: int = 0,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
) -> Filled:
    """Close holes with the fairest surface that goes on from the faces around.

    Triangles over the rim, of the least largest dihedral angle and then of the least area [Barequet
    and Sharir 1995; Liepa 2003]; split, flipped and relaxed to the density of the rim [Botsch and
    Kobbelt 2004]; then faired with the faces around held. Nothing that was there changes, not by a
    bit. Only the faces near a hole take part in fairing.

    Parameters
    ----------
    vertices : (n, 3) float
        In any unit of length.
    faces : (m, 3) or (m, 4) int, a list of polygons, or the pair (corners, offsets) of flat arrays
        All looking the same way.
    holes : sequence
        Each a loop of vertex ids, as find_holes() gives them, in either direction; or a sequence of
        such loops, the rim first, then those of islands in the hole. None: all holes, each loop by
        itself.
    joint : "position", "tangent" or "curvature"
        What the filling takes over at the rim: nothing but the place (the least area), the tangent
        planes (of one ring of faces), or the curvature (of two rings).
    energy : "total_curvature", "thin_plate" or "minimum_variation"
        As in fair(). Where it does not converge, or folds, the thin plate takes its place
        (FilledHole.energy).
    density : float
        New edges are so many times as short as those of the rim: 1 as long, 2 half as long. 0: no
        new vertices, but where the mesh would get an edge twice.
    threads : int
        0: all cores. The result is the same, to the last bit, for any number.
    progress : callable(fraction, phase)
        Called from this thread; returning False cancels.
    monitor : Monitor
        For watching and cancelling from another thread.

    Returns
    -------
    Filled

    Raises
    ------
    FairingError
        BAD_OPTION for a loop that is no hole, NONMANIFOLD_EDGE, REPEATED_VERTEX and
        INDEX_OUT_OF_RANGE with the ids concerned; TOO_LARGE for loops of more than 16,384 vertices;
        CANCELLED after a cancel.
    """
    check_watchers(progress, monitor)
    if joint not in _RINGS:
        raise fairing_error("BAD_OPTION", f"joint is {joint!r}; it must be one of {list(_RINGS)}.")
    native_options(energy=energy, threads=threads)  # refuses what fair() would
    if not (isinstance(density, int | float) and 0.0 <= density <= 100.0):
        raise fairing_error("BAD_OPTION", f"density is {density!r}; it must be from 0 to 100.")
    points = vertex_array(vertices)
    corners, offsets = face_arrays(faces)
    watched = SeveralRuns(progress, monitor, threads)
    whole = _Mesh.of(points, corners, offsets)
    quiet = watched.run(0.0, 0.1)
    watchers = quiet["monitor"], quiet["progress"]
    if holes is None:
        asked = [[h] for h in _native.Filler(points, corners, offsets).find(*watchers)]
    else:
        asked = _asked(holes)
    mesh = _around(whole, asked)
    loops = asked if mesh is whole else [[mesh.renumbered(loop) for loop in hole] for hole in asked]
    filler = _native.Filler(mesh.points, mesh.corners, mesh.offsets)
    try:
        found = filler.fill(loops, float(density), *watchers)
    except _native.FairingError as error:
        if mesh is whole or error.code == "CANCELLED":
            raise
        # refused again, but with the ids that the caller knows
        _native.Filler(points, corners, offsets).fill(asked, float(density), *watchers)
        raise
    shares = np.linspace(0.1, 1.0, _ROUNDS * len(loops) + 1)
    states = [("none", True, 0)] * len(loops)
    seen: list[_Near] = []
    for turn in range(_ROUNDS if joint != "position" else 0):
        if turn:
            if not any(hole.grown > _GROWN for hole in seen):
                break
            found = filler.refine(np.concatenate([own for own, _ in found]), *watchers)
        first, seen = len(mesh.points), []
        for row, (own, triangles) in enumerate(found):
            at = turn * len(loops) + row
            run = watched.run(shares[at], shares[at + 1])
            near = _Near(mesh, own, triangles, first, _RINGS[joint])
            try:
                moved, states[row] = near.faired(energy, run)
            except _native.FairingError as error:
                if not error.elements:
                    raise
                raise _in_whole(error, row, near) from error
            seen.append(near)
            first += len(own)
            found[row] = moved, triangles
    watched.finish()
    fresh = len(points) + np.arange(sum(len(own) for own, _ in found))
    places = np.concatenate([mesh.vertex_ids, fresh])
    found = [(own, places[triangles]) for own, triangles in found]
    return _put_together(whole, [list(map(np.array, h)) for h in asked], found, states)


def _asked(holes: Sequence[Any]) -> list[list[list[int]]]:
    """The caller's holes as loops of plain ids."""
    found = []
    for hole in holes:
        nested = len(hole) > 0 and np.ndim(hole[0]) == 1
        parts = hole if nested else [hole]
        found.append([index_array(part, "holes").reshape(-1).tolist() for part in parts])
    return found


@dataclass(frozen=True)
class _Mesh:
    """A mesh, or a part of one."""

    points: np.ndarray  # (n, 3)
    corners: np.ndarray  # (c,)
    offsets: np.ndarray  # (m + 1,)
    vertex_ids: np.ndarray  # (n,) what the whole calls its vertices, rising
    face_ids: np.ndarray  # (m,)

    @classmethod
    def of(cls, points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> _Mesh:
        return cls(points, corners, offsets, np.arange(len(points)), np.arange(len(offsets) - 1))

    def part(self, faces: np.ndarray) -> _Mesh:
        """Some faces, and the vertices that they have, in their old order."""
        sizes = self.offsets[faces + 1] - self.offsets[faces]
        ids, corners = np.unique(self.corners_at(faces), return_inverse=True)
        offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        return _Mesh(self.points[ids], corners.astype(np.int64), offsets, ids, faces)

    def renumbered(self, loop: Sequence[int]) -> list[int]:
        """A loop of the whole mesh, all of whose vertices are here."""
        return np.searchsorted(self.vertex_ids, loop).tolist()

    def touching(self, vertices: np.ndarray) -> np.ndarray:
        """(f,) ids of the faces with one of these vertices."""
        marked = np.zeros(len(self.points), bool)
        marked[vertices] = True
        at = np.flatnonzero(marked[self.corners])
        return np.unique(np.searchsorted(self.offsets, at, side="right") - 1)

    def corners_at(self, faces: np.ndarray) -> np.ndarray:
        """All corners of these faces, face after face."""
        sizes = self.offsets[faces + 1] - self.offsets[faces]
        return self.corners[_runs(self.offsets[faces], sizes)]


def _runs(starts: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """start, start + 1, … of each, `size` of them, one after another."""
    return np.arange(sizes.sum()) + np.repeat(starts - np.cumsum(sizes) + sizes, sizes)


def _around(whole: _Mesh, holes: list[list[list[int]]]) -> _Mesh:
    """The faces around these holes: as many rings as any joint reads. Two are also all that the
    filling itself looks at. Arrays and loops that the core will refuse stay whole, for it to say why.
    """
    flat = [v for hole in holes for loop in hole for v in loop]
    count = len(whole.points)
    if not flat or min(flat) < 0 or max(flat) >= count or not len(whole.corners):
        return whole
    if not (np.isfinite(whole.points).all() and np.diff(whole.offsets).min() >= 3):
        return whole
    if whole.corners.min() < 0 or whole.corners.max() >= count:
        return whole
    ids = np.array(flat)
    for _ in range(max(_RINGS.values())):
        faces = whole.touching(ids)
        ids = np.unique(np.concatenate([ids, whole.corners_at(faces)]))
    part = whole.part(faces)
    return part if np.isin(flat, part.vertex_ids).all() else whole


def _in_whole(error: _native.FairingError, hole: int, near: _Near) -> _native.FairingError:
    """What fair() refused beside a hole, with the ids of the whole mesh; new elements have none."""
    names = near.face_ids if error.kind == "face" else near.vertex_ids
    ids = [int(names[i]) for i in error.elements if i < len(names)]
    said = re.sub(r" \(\d[^)]*\)", "", str(error))
    shown = ", ".join(map(str, ids[:_SHOWN])) + (", …" if len(ids) > _SHOWN else "")
    where = f" ({error.kind} {shown})" if ids else ""
    text = f"Around hole {hole}{where}: {said}"
    return fairing_error(error.code, text, ids, error.kind if ids else "mesh")


class _Near:
    """What fills one hole, and the faces around, as a mesh of its own."""

    def __init__(
        self, mesh: _Mesh, own: np.ndarray, triangles: np.ndarray, first: int, rings: int
    ) -> None:
        self._own = own
        rim = np.unique(triangles[triangles < len(mesh.points)])
        touching = np.empty(0, np.int64)
        ids = rim
        for _ in range(rings):
            touching = mesh.touching(ids)
            ids = np.unique(np.concatenate([rim, mesh.corners_at(touching)]))
        size = len(ids)
        fresh = np.arange(first, first + len(own))
        self._vertices = np.concatenate([mesh.points[ids], own])
        known = np.concatenate([ids, fresh])
        self._new = np.searchsorted(known, triangles)
        around = np.searchsorted(known, mesh.corners_at(touching))
        sizes = mesh.offsets[touching + 1] - mesh.offsets[touching]
        ends = np.cumsum(np.concatenate([[0], sizes, np.full(len(triangles), 3)]))
        self._faces = np.concatenate([around, self._new.ravel()]), ends
        self.vertex_ids = mesh.vertex_ids[ids]
        self.face_ids = mesh.face_ids[touching]
        self.grown = 1.0  # the area of the filling, over that before it was faired
        self._weights = np.where(np.arange(len(known)) < size, np.inf, 0.0)

    def faired(
        self, energy: str, watchers: dict[str, Any]
    ) -> tuple[np.ndarray, tuple[str, bool, int]]:
        """The places of its own vertices; the energy, whether it converged, and folds."""
        if not len(self._own):
            return self._own, ("none", True, self._folds(self._vertices))
        tries = []
        for functional in dict.fromkeys([energy, "thin_plate"]):
            result = fair(
                self._vertices,
                self._faces,
                levels=0,
                energy=functional,
                interpolation="approximate",
                weights=self._weights,
                **watchers,
            )
            levels = result.report.get("curvature") or [{"converged": True}]
            folds = self._folds(result.vertices)
            moved = result.vertices[len(self._vertices) - len(self._own) : len(self._vertices)]
            tries.append((moved, (functional, bool(levels[-1]["converged"]), folds)))
            if levels[-1]["converged"] and not folds:
                break
        moved, state = min(tries, key=lambda t: (t[1][2], not t[1][1]))
        vertices = np.concatenate([self._vertices[: len(self._vertices) - len(moved)], moved])
        self.grown = self._area(vertices) / self._area(self._vertices)
        return moved, state

    def _normals(self, vertices: np.ndarray) -> np.ndarray:
        """(t, 3) of its new triangles, twice as long as their areas."""
        corner = vertices[self._new]
        return np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])

    def _area(self, vertices: np.ndarray) -> float:
        return float(np.linalg.norm(self._normals(vertices), axis=1).sum())

    def _folds(self, vertices: np.ndarray) -> int:
        """Edges between new triangles that turn by more than a right angle."""
        normal = self._normals(vertices)
        sides = np.sort(self._new[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        owner = np.repeat(np.arange(len(self._new)), 3)
        order = np.lexsort(sides.T)
        sides, owner = sides[order], owner[order]
        same = np.flatnonzero((sides[1:] == sides[:-1]).all(axis=1))
        return int(((normal[owner[same]] * normal[owner[same + 1]]).sum(axis=1) < 0.0).sum())


def _put_together(
    mesh: _Mesh,
    loops: list[list[np.ndarray]],
    found: list[tuple[np.ndarray, np.ndarray]],
    states: list[tuple[str, bool, int]],
) -> Filled:
    count, faces = len(mesh.points), len(mesh.offsets) - 1
    holes = []
    vertex, face = count, faces
    for rims, (own, triangles), state in zip(loops, found, states, strict=True):
        more, filled = range(vertex, vertex + len(own)), range(face, face + len(triangles))
        holes.append(FilledHole(rims, more, filled, *state))
        vertex, face = more.stop, filled.stop
    vertices = np.concatenate([mesh.points, *(own for own, _ in found)])
    new = np.concatenate([np.empty((0, 3), np.int64), *(t for _, t in found)]).astype(np.int64)
    sizes = np.diff(mesh.offsets)
    corners = np.concatenate([mesh.corners, new.reshape(-1)])
    if (sizes == 3).all():
        whole: Any = corners.reshape(-1, 3)
    else:
        ends = mesh.offsets[-1] + 3 * np.arange(1, len(new) + 1)
        whole = corners, np.concatenate([mesh.offsets, ends])
    return Filled(vertices, whole, np.arange(faces, face), holes)
