# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes of a mesh, found and closed by the fairest surface."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, index_array, vertex_array
from .errors import fairing_error
from .near_hole import NOISY_RINGS, RIMS, RINGS, Made, MeshPart, NearHole, RefusedAround
from .options import native_options
from .watching import Progress, SeveralRuns, check_watchers

# A filling is remeshed where fairing has made its area so many times as large: up to there its edges
# are within a tenth of the length wanted, and to fair it twice only costs as much again.
_GROWN = 1.2

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
        The energy that was minimized; "none" where the first triangulation, spread as a membrane, was
        left as it was.
    joint: str
        What it took over at the rim.
    converged: bool
        Whether its steps came to their end; False where the triangulation stands in.
    folds: int
        Edges at which the surface turns back, the rim's included.
    """

    loops: list[np.ndarray]
    vertices: range
    faces: range
    energy: str
    joint: str
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
    rim: str = "exact",
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
        As in fair(). Where it does not converge, or folds, the thin plate takes its place, where this
        folds, too, the thin plate with the tangent alone, then the triangulation spread as a membrane,
        and at last that without new vertices (FilledHole.energy, FilledHole.joint).
    density : float
        New edges are so many times as short as those of the rim: 1 as long, 2 half as long. 0: no
        new vertices, but where the mesh would get an edge twice.
    rim : "exact" or "noisy"
        Noisy: six rings of faces around say how the surface goes on, and all but the outermost may be
        missed, so that the noise of a scan is not carried on. The rim itself stays, as all that was
        there.
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
    if joint not in RINGS:
        raise fairing_error("BAD_OPTION", f"joint is {joint!r}; it must be one of {list(RINGS)}.")
    if rim not in RIMS:
        raise fairing_error("BAD_OPTION", f"rim is {rim!r}; it must be one of {list(RIMS)}.")
    native_options(energy=energy, threads=threads)  # refuses what fair() would
    if not (isinstance(density, int | float) and 0.0 <= density <= 100.0):
        raise fairing_error("BAD_OPTION", f"density is {density!r}; it must be from 0 to 100.")
    points = vertex_array(vertices)
    corners, offsets = face_arrays(faces)
    watched = SeveralRuns(progress, monitor, threads)
    whole = MeshPart.of(points, corners, offsets)
    quiet = watched.run(0.0, 0.1)
    watchers = quiet["monitor"], quiet["progress"]
    if holes is None:
        asked = [[h] for h in _native.Filler(points, corners, offsets).find(*watchers)]
    else:
        asked = _asked(holes)
    mesh = _around(whole, asked, NOISY_RINGS if rim == "noisy" else max(RINGS.values()))
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
    made: list[Made] = []
    seen: list[NearHole] = []
    for turn in range(_ROUNDS):
        if turn:
            if not any(hole.grown > _GROWN for hole in seen) and not any(by.folds for by in made):
                break
            found = filler.refine(np.concatenate([own for own, _ in found]), *watchers)
        first, seen, made = len(mesh.points), [], []
        for row, (own, triangles) in enumerate(found):
            at = turn * len(loops) + row
            run = watched.run(shares[at], shares[at + 1])
            near = NearHole(mesh, own, triangles, first)
            try:
                moved, by = near.faired(energy, joint, rim == "noisy", run)
            except RefusedAround as refused:
                raise _said(refused, row) from refused
            seen.append(near)
            made.append(by)
            first += len(own)
            found[row] = moved, triangles
    if any(by.folds for by in made) and density > 0.0:
        bare = filler.fill(loops, 0.0, *watchers)
        found, made = _unfolded(mesh, found, made, bare)
    watched.finish()
    fresh = len(points) + np.arange(sum(len(own) for own, _ in found))
    places = np.concatenate([mesh.vertex_ids, fresh])
    found = [(own, places[triangles]) for own, triangles in found]
    return _put_together(whole, [list(map(np.array, h)) for h in asked], found, made)


Filling: TypeAlias = tuple[np.ndarray, np.ndarray]  # own vertices (k, 3), triangles of ids (t, 3)


def _unfolded(
    mesh: MeshPart, found: list[Filling], made: list[Made], bare: list[Filling]
) -> tuple[list[Filling], list[Made]]:
    """`found`, and in the place of what folds the `bare` triangles between the vertices of the rim,
    where these do not: only what any such triangles would have is left to fold.
    """
    count = len(mesh.points)
    chosen, made = list(found), list(made)
    first = [np.cumsum([count] + [len(own) for own, _ in part]) for part in (found, bare)]
    begin = first[0][:-1].tolist()
    for k, (own, triangles) in enumerate(bare):
        if not made[k].folds:
            continue
        plain = NearHole(mesh, own, triangles, int(first[1][k])).as_triangulated(True)
        others = np.concatenate(
            [t for row, (_, t) in enumerate(chosen) if row != k] or [triangles[:0]]
        )
        if not plain.folds and not _share_edges(triangles, others, count):
            made[k], chosen[k], begin[k] = plain, (own, triangles), int(first[1][k])
    fresh, renumbered = count, []
    for (own, triangles), old in zip(chosen, begin, strict=True):
        renumbered.append((own, np.where(triangles < count, triangles, triangles - old + fresh)))
        fresh += len(own)
    return renumbered, made


def _share_edges(triangles: np.ndarray, others: np.ndarray, count: int) -> bool:
    """Whether some edge between two vertices of the mesh, which has `count`, is in both."""
    keys = []
    for part in (triangles, others):
        sides = np.sort(part[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
        sides = sides[sides[:, 1] < count]
        keys.append(sides[:, 0] * count + sides[:, 1])
    return bool(np.isin(keys[0], keys[1]).any())


def _asked(holes: Sequence[Any]) -> list[list[list[int]]]:
    """The caller's holes as loops of plain ids."""
    found = []
    for hole in holes:
        nested = len(hole) > 0 and np.ndim(hole[0]) == 1
        parts = hole if nested else [hole]
        found.append([index_array(part, "holes").reshape(-1).tolist() for part in parts])
    return found


def _around(whole: MeshPart, holes: list[list[list[int]]], rings: int) -> MeshPart:
    """The faces around these holes: so many rings. Two are all that the filling itself looks at. Arrays and loops that the core will refuse stay whole, for it to say why."""
    flat = [v for hole in holes for loop in hole for v in loop]
    count = len(whole.points)
    if not flat or min(flat) < 0 or max(flat) >= count or not len(whole.corners):
        return whole
    if not (np.isfinite(whole.points).all() and np.diff(whole.offsets).min() >= 3):
        return whole
    if whole.corners.min() < 0 or whole.corners.max() >= count:
        return whole
    ids = np.array(flat)
    for _ in range(rings):
        faces = whole.touching(ids)
        ids = np.unique(np.concatenate([ids, whole.corners_at(faces)]))
    part = whole.part(faces)
    return part if np.isin(flat, part.vertex_ids).all() else whole


def _said(refused: RefusedAround, hole: int) -> _native.FairingError:
    """What fair() refused beside a hole, with the ids of the whole mesh."""
    ids, error = refused.elements, refused.error
    said = re.sub(r" \(\d[^)]*\)", "", str(error))
    shown = ", ".join(map(str, ids[:_SHOWN])) + (", …" if len(ids) > _SHOWN else "")
    where = f" ({error.kind} {shown})" if ids else ""
    text = f"Around hole {hole}{where}: {said}"
    return fairing_error(error.code, text, ids, error.kind if ids else "mesh")


def _put_together(
    mesh: MeshPart,
    loops: list[list[np.ndarray]],
    found: list[tuple[np.ndarray, np.ndarray]],
    made: list[Made],
) -> Filled:
    count, faces = len(mesh.points), len(mesh.offsets) - 1
    holes = []
    vertex, face = count, faces
    for rims, (own, triangles), by in zip(loops, found, made, strict=True):
        more, filled = range(vertex, vertex + len(own)), range(face, face + len(triangles))
        holes.append(FilledHole(rims, more, filled, by.energy, by.joint, by.converged, by.folds))
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
