# SPDX-License-Identifier: GPL-3.0-or-later
"""The filling of one hole, faired together with the faces around the hole."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .. import _native
from ..arrays import face_vectors, following
from ..fairing import fair
from ..mesh_part import MeshPart

# Rings of faces around a hole whose vertices determine how the surface continues.
RINGS = {"position": 0, "tangent": 1, "curvature": 2}

# At a noisy rim: the number of rings; the two outermost rows of vertices are held, the others have this
# weight. Chosen from 4 and 6 rings on spheres, and from weights of 0.3 to 10 on seven surfaces, with a
# noise of 0.02 and 0.1 edges (docs/developers/notes/filling.md).
NOISY_RINGS, HELD_ROWS, NOISY_WEIGHT = 6, 2, 1.0

RIMS = {"exact": False, "noisy": True}

# Half of what fair() has by default, which left a half sphere 9e-6 off its sphere; now 6e-8, in the same time.
_STEP_TOLERANCE = 5e-6


@dataclass(frozen=True, slots=True)
class Made:
    """How the surface of a filling was computed."""

    energy: str  # "none": as it was triangulated
    joint: str
    converged: bool
    folds: int
    folds_inside: int  # folds between two faces of the filling
    ignored: tuple[int, ...] = ()  # ids in the whole mesh of faces around the hole

    @property
    def stands_in(self) -> bool:
        """Whether the triangulation replaces a requested surface."""
        return self.energy == "none" and not self.converged


@dataclass(frozen=True, slots=True)
class Wanted:
    energy: str
    joint: str
    noisy: bool  # more rings determine the continuation, none of them exactly
    density: float

    @property
    def triangles(self) -> tuple[float, bool]:
        """The density of new triangles, and whether remeshing follows the normals of the faces around."""
        return self.density, self.joint != "position"

    @property
    def ways(self) -> list[tuple[str, str]]:
        """Pairs (energy, joint) in the order of trial: the requested pair; the thin plate, which needs no
        steps; the thin plate with joint "tangent", since noise in two rings may spoil their curvature.
        """
        if self.joint == "position":
            return []
        found = [(self.energy, self.joint), ("thin_plate", self.joint), ("thin_plate", "tangent")]
        return list(dict.fromkeys(found))


# Codes of fair() that do not concern a hole.
_NOT_OF_A_HOLE = ("CANCELLED", "OUT_OF_MEMORY", "FORKED")


class NearHole:
    """The filling of one hole and the faces around the hole. `own` (k, 3) are the filling's new vertices,
    with ids from `first` on; `faces` (t, 3) contain vertex ids.
    """

    def __init__(self, mesh: MeshPart, own: np.ndarray, faces: np.ndarray, first: int) -> None:
        self.own, self.faces, self.first = own, faces, first
        self._mesh = mesh
        self._rim = np.unique(faces[faces < len(mesh.points)])
        self._ignored = np.empty(0, np.int64)  # faces around that fair() has refused
        self._held = np.zeros(len(own), bool)  # new vertices that must not move
        # by energy and joint, while none is held
        self._known: dict[tuple[str, str], tuple[np.ndarray, Made] | None] = {}

    @cached_property
    def _beside(self) -> _SidesBehind:
        return _SidesBehind(self._mesh, self._rim, self.faces)

    def faired(
        self, wanted: Wanted, watchers: dict[str, Any], stands_in: bool = True
    ) -> tuple[np.ndarray, Made, np.ndarray]:
        """Positions of the new vertices, how they were computed, and the positions from which a run on
        better triangles starts: those of the requested energy, even if they fold. `stands_in`: whether
        other energies are tried if the requested one folds; the first without folds is taken, or the one
        with the fewest.
        """
        if not len(self.own):
            return self.own, self.as_triangulated(), self.own
        tries: list[tuple[np.ndarray, Made]] = []
        onward: np.ndarray | None = None
        for way in wanted.ways:
            found = self._solved(way, wanted.noisy, watchers)
            if found is not None:
                onward = found[0] if onward is None else onward
                tries.append(found)
            if not stands_in or (found and not found[1].folds):
                break
        else:
            tries.append((self.own, self.as_triangulated(wanted.joint != "position")))
        if not tries:
            tries.append((self.own, self.as_triangulated(True)))
        moved, made = min(tries, key=lambda t: t[1].folds)
        return moved, made, moved if onward is None else onward

    def other_ways(
        self, wanted: Wanted, watchers: dict[str, Any]
    ) -> Iterator[tuple[np.ndarray, Made]]:
        """Positions of the new vertices: by the requested energy, repeated while hold() fixes more of
        them, then by each other energy that gives a surface.
        """
        for way in wanted.ways[: 1 if len(self.own) else 0]:
            known = -1
            while self._held.sum() > known:
                known = int(self._held.sum())
                found = self._solved(way, wanted.noisy, watchers)
                if found is None:
                    break
                yield found
        self._held[:] = False
        for way in wanted.ways[1:]:
            found = self._solved(way, wanted.noisy, watchers)
            if found is not None:
                yield found
        if wanted.joint != "position":
            yield self.own, self.as_triangulated(True)

    def hold(self, faces: np.ndarray, own: np.ndarray) -> None:
        """Fixes the vertices of `faces`, of faces that fold while the new vertices are at `own`, and of
        the neighbours of both."""
        bad = np.union1d(faces, self._beside.folding(self._normals(own)))
        beside = np.isin(self.faces, self.faces[bad]).any(axis=1)
        mine = self.faces[beside] - self.first
        self._held[mine[mine >= 0]] = True

    def as_triangulated(self, stands_in: bool = False) -> Made:
        """The triangulation without fairing; `stands_in`: it replaces a requested surface."""
        return Made("none", "position", not stands_in, *self._folds(self.own))

    def _solved(
        self, way: tuple[str, str], noisy: bool, watchers: dict[str, Any]
    ) -> tuple[np.ndarray, Made] | None:
        """None if fair() refuses the filling itself. If fair() refuses faces around the hole, they are
        ignored from then on and do not determine the continuation.
        """
        if self._held.any():
            return self._solve(*way, noisy, watchers)
        if way not in self._known:
            self._known[way] = self._solve(*way, noisy, watchers)
        return self._known[way]

    def _solve(
        self, energy: str, joint: str, noisy: bool, watchers: dict[str, Any]
    ) -> tuple[np.ndarray, Made] | None:
        while True:
            rows, touching = self._around(NOISY_RINGS if noisy else RINGS[joint])
            weights = np.full(len(rows[-1]), np.inf)
            if noisy:
                weights[np.isin(rows[-1], rows[-1 - HELD_ROWS])] = NOISY_WEIGHT
            try:
                moved, converged = self._fair(rows[-1], touching, weights, energy, watchers)
            except _native.FairingError as error:
                if error.code in _NOT_OF_A_HOLE:
                    raise
                refused = self._refused(rows[-1], touching, error)
                if not len(refused):
                    return None
                self._ignored = np.union1d(self._ignored, refused)
                continue
            ignored = tuple(self._mesh.face_ids[self._ignored].tolist())
            return moved, Made(energy, joint, converged, *self._folds(moved), ignored)

    def _around(self, rings: int) -> tuple[list[np.ndarray], np.ndarray]:
        """The rim's vertices, then the vertices after each ring of faces is added; and these faces."""
        rows, touching = [self._rim], np.empty(0, np.int64)
        for _ in range(rings):
            touching = np.setdiff1d(self._mesh.faces_at(rows[-1]), self._ignored)
            rows.append(np.union1d(self._rim, self._mesh.corners_at(touching)))
        return rows, touching

    def _fair(
        self,
        ids: np.ndarray,
        touching: np.ndarray,
        weights: np.ndarray,
        energy: str,
        watchers: dict[str, Any],
    ) -> tuple[np.ndarray, bool]:
        """Positions of the new vertices, faired with the faces `touching`, whose vertices `ids` have
        `weights`; and whether the steps have converged.
        """
        mesh = self._mesh
        known = np.concatenate([ids, np.arange(self.first, self.first + len(self.own))])
        corners = np.concatenate([mesh.corners_at(touching), self.faces.ravel()])
        sizes = mesh.offsets[touching + 1] - mesh.offsets[touching]
        ends = np.cumsum(np.concatenate([[0], sizes, np.full(len(self.faces), 3)]))
        result = fair(
            np.concatenate([mesh.points[ids], self.own]),
            (np.searchsorted(known, corners), ends),
            levels=0,
            energy=energy,
            step_tolerance=_STEP_TOLERANCE,
            interpolation="approximate",
            weights=np.concatenate([weights, np.where(self._held, np.inf, 0.0)]),
            **watchers,
        )
        levels = result.report.get("curvature") or [{"converged": True}]
        return result.vertices[len(ids) : len(known)], bool(levels[-1]["converged"])

    def _refused(
        self, ids: np.ndarray, touching: np.ndarray, error: _native.FairingError
    ) -> np.ndarray:
        """The faces of `touching` that an error of _fair() names."""
        named = np.ravel(error.elements).astype(np.int64)
        if error.kind != "face":
            at = self._mesh.faces_at(ids[named[named < len(ids)]])
            return np.intersect1d(at, touching)
        found = touching[named[named < len(touching)]]
        if error.code == "INCONSISTENT_ORIENTATION" and (named >= len(touching)).any():
            return np.setdiff1d(touching, found)  # the others are oriented against the filling
        return found

    def corners(self, own: np.ndarray) -> np.ndarray:
        """(t, 3, 3) corner positions of the filling's faces, with the new vertices at `own`."""
        rows = np.where(
            self.faces < len(self._mesh.points),
            np.searchsorted(self._rim, self.faces),
            self.faces - self.first + len(self._rim),
        )
        return np.concatenate([self._mesh.points[self._rim], own])[rows]

    def _normals(self, own: np.ndarray) -> np.ndarray:
        """(t, 3) normals of the filling's faces; the length is twice the area."""
        corner = self.corners(own)
        return np.cross(corner[:, 2] - corner[:, 0], corner[:, -1] - corner[:, 1])

    def area(self, own: np.ndarray) -> float:
        return float(np.linalg.norm(self._normals(own), axis=1).sum())

    def _folds(self, own: np.ndarray) -> tuple[int, int]:
        """Edges of the filling that turn by more than a right angle: all edges, and without the rim."""
        return self._beside.folds(self._normals(own))


class _SidesBehind:
    """Pairs of a filling's faces that share an edge, and the mesh faces behind the rim's edges."""

    def __init__(self, mesh: MeshPart, rim: np.ndarray, own: np.ndarray) -> None:
        sides = np.sort(np.stack([own, np.roll(own, -1, axis=1)], -1).reshape(-1, 2), axis=1)
        owner = np.repeat(np.arange(len(own)), own.shape[1])
        order = np.lexsort(sides.T)
        sides, owner = sides[order], owner[order]
        same = np.flatnonzero((sides[1:] == sides[:-1]).all(axis=1))
        self._pairs = np.stack([owner[same], owner[same + 1]])
        alone = np.ones(len(sides), bool)
        alone[same] = alone[same + 1] = False
        faces = mesh.faces_at(rim)
        corners = mesh.corners_at(faces)
        sizes = mesh.offsets[faces + 1] - mesh.offsets[faces]
        offsets = np.concatenate([[0], np.cumsum(sizes)])
        normals = face_vectors(mesh.points, corners, offsets)
        theirs = np.sort(np.stack([corners, corners[following(offsets)]], axis=1), axis=1)
        count = len(mesh.points)
        keys = theirs[:, 0] * count + theirs[:, 1]
        rows = np.argsort(keys, kind="stable")
        wanted = sides[alone][:, 0] * count + sides[alone][:, 1]
        at = rows[np.searchsorted(keys[rows], wanted)]
        self._at_rim = owner[alone]
        self._behind = normals[np.repeat(np.arange(len(faces)), sizes)[at]]

    def _turned(self, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pairs, and faces at the rim, that turn by more than a right angle with these `normals`."""
        inside = (normals[self._pairs[0]] * normals[self._pairs[1]]).sum(axis=1) < 0.0
        at_rim = (normals[self._at_rim] * self._behind).sum(axis=1) < 0.0
        return self._pairs[:, inside], self._at_rim[at_rim]

    def folding(self, normals: np.ndarray) -> np.ndarray:
        """Faces at edges that turn by more than a right angle."""
        return np.union1d(*self._turned(normals))

    def folds(self, normals: np.ndarray) -> tuple[int, int]:
        """The numbers of such edges: of all, and of those between two faces of the filling."""
        inside, at_rim = self._turned(normals)
        return inside.shape[1] + len(at_rim), inside.shape[1]
