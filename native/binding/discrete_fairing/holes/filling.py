# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the holes of a mesh and fills them with the fairest surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import face_arrays, index_array, vertex_array
from ..converters import choice, size
from ..mesh_part import MeshPart
from ..options import native_options
from ..watching import Progress, SeveralRuns, check_watchers
from .crossings import in_whole, with_less_crossing
from .edge_cuts import cuts_for, sides_of
from .filled import Filled, FilledHole, SkippedHole
from .near_hole import NOISY_RINGS, RIMS, RINGS, NearHole, Wanted
from .rounds import Filling, faired_in_rounds, near_holes, without_folds


def find_holes(vertices: ArrayLike, faces: ArrayLike | Sequence[Sequence[int]]) -> list[np.ndarray]:
    """The holes of a mesh for fill_holes(): (k,) int64 vertex ids around each, in the direction of a
    face that fills it.

    A border that touches itself in a vertex is cut there into several loops. The border of an open
    sheet is a loop too. Loops begin with their least id and are sorted by it. Left out, and listed by
    fill_holes(), are borders with edges of more than two faces or with neighbours of different
    orientation, where holes are ambiguous, and loops of more than 16,384 vertices. Raises FairingError
    for invalid arrays.
    """
    filler = _native.Filler(vertex_array(vertices), *face_arrays(faces))
    loops, _ = filler.find(_native.Monitor(), None)
    return [np.array(loop, np.int64) for loop in loops]


def with_islands(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    loops: Sequence[ArrayLike] | None = None,
) -> list[list[np.ndarray]]:
    """Combines `loops` of find_holes(), or all loops, to holes with islands: for each hole its rim and the
    rims of its islands.

    A loop inside another one, seen along its normal, is the rim of an island if it has the opposite
    direction, is farther from the rim in its plane than along its normal, and the faces at both continue
    towards the ring between. So the inner and outer wall of a pipe are joined at its ends, and the border
    of a sheet is not joined to the holes in it. Raises FairingError for invalid arrays and loops.
    """
    filler = _native.Filler(vertex_array(vertices), *face_arrays(faces))
    watchers = _native.Monitor(), None
    asked = filler.find(*watchers)[0] if loops is None else [hole[0] for hole in asked_holes(loops)]
    found = filler.with_islands(asked, *watchers)
    return [[np.array(loop, np.int64) for loop in hole] for hole in found]


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
    """Fill holes with the fairest surface that continues the faces around.

    The rim is triangulated with the least largest dihedral angle and then the least area [Barequet
    and Sharir 1995; Liepa 2003]; the triangles are split, flipped and relaxed to the density of the rim, far
    inside to edges of 8 % of the distance from it [Botsch and Kobbelt 2004], then faired with the faces
    around held. Existing elements do not change, bit for bit. Only the faces near a hole are used.

    Parameters
    ----------
    vertices : (n, 3) float
        In any unit of length.
    faces : (m, 3) or (m, 4) int, a list of polygons, or the pair (corners, offsets) of flat arrays
        With the same orientation.
    holes : sequence
        Each a loop of vertex ids from find_holes(), in either direction; or a sequence of such loops, in
        any order: the rim of the hole and those of its islands. None: all holes of with_islands().
    joint : "position", "tangent" or "curvature"
        What the filling continues at the rim: the position only (least area), the tangent planes (one
        ring of faces), or the curvature (two rings).
    energy : "total_curvature", "thin_plate" or "minimum_variation"
        As in fair(). If the filling folds or grows, it is repeated from its own shape on new triangles, at
        most four times. Where it still folds or crosses other faces, the vertices stay as triangulated. If
        that does not help, these are tried: the thin plate, the thin plate with the tangent alone, the
        triangulation spread as a membrane, the triangulation without new vertices (FilledHole.energy,
        FilledHole.joint).
    density : float
        Length of the rim's edges over that of new edges beside them: 1 as long, 2 half as long. 0: no new vertices,
        unless the mesh would get an edge twice.
    rim : "exact" or "noisy"
        Noisy: six rings of faces are continued, and all but the outermost may be missed, so that the
        noise of a scan does not continue. The rim itself does not move.
    threads, progress, monitor
        As of fair().

    Returns
    -------
    Filled
        Holes that cannot be filled are listed in `skipped`: a loop that is not a hole (BAD_OPTION,
        REPEATED_VERTEX) or has more than 16,384 vertices (TOO_LARGE), a rim of faces with different
        orientations (INCONSISTENT_ORIENTATION) or with edges of more than two faces (NONMANIFOLD_EDGE), a
        slit (COINCIDENT_VERTICES), a vertex on an edge (DEGENERATE_FACE).

    Raises
    ------
    FairingError
        BAD_OPTION for an option out of its range and a loop of fewer than three vertices,
        INDEX_OUT_OF_RANGE for missing vertices, CANCELLED, and the errors of check() for invalid arrays.
    """
    check_watchers(progress, monitor)
    choice(RINGS)("joint", joint)
    native_options({"energy": energy, "threads": threads})  # refuses what fair() would
    noisy = choice(RIMS)("rim", rim)
    wanted = Wanted(energy, joint, noisy, size("density", density, 100.0))
    points = vertex_array(vertices)
    corners, offsets = face_arrays(faces)
    watched = SeveralRuns(progress, monitor, threads)
    whole = MeshPart.of(points, corners, offsets)
    watchers = watched.watchers(0.1)
    skipped = []
    if holes is None:
        finder = _native.Filler(points, corners, offsets)
        known, unclear = finder.find(*watchers)
        asked = finder.with_islands(known, *watchers)
        skipped = [SkippedHole.of([], why, whole.vertex_ids) for why in unclear]
    else:
        asked = asked_holes(holes)
    mesh = _around(whole, asked, NOISY_RINGS if noisy else max(RINGS.values()))
    loops = asked if mesh is whole else [[mesh.renumbered(loop) for loop in hole] for hole in asked]
    filler = _native.Filler(mesh.points, mesh.corners, mesh.offsets)
    by_row, why = _triangulated(filler, loops, wanted.triangles, watchers)
    flat = [asked[row] for row, reason in why.items() if reason["code"] == "DEGENERATE_FACE"]
    cuts = cuts_for(points, corners, offsets, [hole[0] for hole in flat if len(hole) == 1])
    for row, reason in why.items():
        if cuts.keys().isdisjoint(sides_of(asked[row][0])):
            rims = list(map(np.array, asked[row]))
            skipped.append(SkippedHole.of(rims, reason, mesh.vertex_ids))
    asked, loops = ([all_[row] for row in by_row] for all_ in (asked, loops))
    nears = near_holes(mesh, list(by_row.values()))
    fillings = _faired(mesh, filler, loops, nears, wanted, watched)
    fillings, crossings = with_less_crossing(whole, mesh, nears, fillings, wanted, watched)
    watched.finish()
    filled = []
    for hole, f, count in zip(asked, in_whole(whole, mesh, fillings), crossings, strict=True):
        rims, faces, by = list(map(np.array, hole)), f.faces.astype(np.int64), f.made
        how = by.energy, by.joint, by.converged, by.folds
        filled.append(FilledHole(rims, f.own, faces, *how, count, list(by.ignored)))
    return Filled(filled, skipped, cuts, whole)


_Triangulated = tuple[np.ndarray, np.ndarray]  # new vertices, triangles


def _triangulated(
    filler: _native.Filler,
    holes: list[list[list[int]]],
    triangles: tuple[float, bool],
    watchers: Sequence[Any],
) -> tuple[dict[int, _Triangulated], dict[int, dict[str, Any]]]:
    """The triangulation of each hole, or the reason why there is none; both by the hole's number."""
    found, why = filler.fill(holes, *triangles, *watchers)
    filled = [row for row, reason in enumerate(why) if reason is None]
    refused = {row: reason for row, reason in enumerate(why) if reason is not None}
    return dict(zip(filled, found, strict=True)), refused


def _faired(
    mesh: MeshPart,
    filler: _native.Filler,
    loops: list[list[list[int]]],
    nears: list[NearHole],
    wanted: Wanted,
    watched: SeveralRuns,
) -> list[Filling]:
    """The faired fillings of all holes; triangles without new vertices replace those that fold, if they do not."""
    fillings = faired_in_rounds(mesh, filler, nears, wanted, watched)
    folding = [row for row, filling in fillings.items() if filling.made.folds]
    if wanted.density > 0.0 and folding:
        asked = [loops[row] for row in folding]
        bare, _ = _triangulated(filler, asked, (0.0, False), watched.watchers(1.0))
        fillings = without_folds(mesh, fillings, {folding[k]: own for k, own in bare.items()})
    return [fillings[row] for row in range(len(nears))]


def asked_holes(holes: Sequence[Any]) -> list[list[list[int]]]:
    """The caller's holes as loops of plain ids."""
    found = []
    for hole in holes:
        nested = len(hole) > 0 and np.ndim(hole[0]) == 1
        parts = hole if nested else [hole]
        found.append([index_array(part, "holes").reshape(-1).tolist() for part in parts])
    return found


def _around(whole: MeshPart, holes: list[list[list[int]]], rings: int) -> MeshPart:
    """The faces within `rings` around these holes; the filling itself reads two rings. Arrays and loops
    that the core will refuse are passed on whole, so that the core's error names the cause.
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
    for _ in range(rings):
        faces = whole.touching(ids)
        ids = np.unique(np.concatenate([ids, whole.corners_at(faces)]))
    part = whole.part(faces)
    return part if np.isin(flat, part.vertex_ids).all() else whole
