# SPDX-License-Identifier: GPL-3.0-or-later
"""fit_patches(): spline patches of the fair surface of a control mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, following, numbers, vertex_array
from .checking import predicted_size
from .errors import fairing_error
from .fairing import fair
from .options import real, switch, whole
from .patch_distances import distances_from
from .patches import SplinePatches, control_polygons
from .result import Result
from .scan_fitting import Fitted, fit
from .watching import Progress, SeveralRuns, check_watchers

FIRST_LEVEL, LAST_LEVEL, LEAST_LEVEL = 5, 8, 3
USUAL_TOLERANCE, USUAL_ANGLE = 1e-4, 8e-4  # share of the size; radians
# The allowed distance of patches from a surface, as a share of the distance of 95 % of the scan from it.
# Independent errors add by squares, so patches at this distance put points 12 % farther away.
SHARE_OF_SCAN = 0.5
# Largest numbers of points: of the first surface, of a finer one that converges better, and of one
# whose patches must meet a tolerance.
MOST_POINTS, MOST_FINER_POINTS, MOST_POINTS_FOR_FACES = 6_000_000, 300_000, 1_200_000
TURN_LIMIT = np.radians(20.0)  # between neighbouring cells of the refined surface
# the same on a coarse level, above which a fold remains on finer ones
HOPELESS_TURN = np.radians(150.0)
FOLD_LIMIT = np.radians(45.0)  # between a patch and the refined surface
# The error of the refined surface itself, as a share of the tolerance.
LATTICE_SHARE = 0.5
# The change to the next level over the sum of all later changes, which fall by a factor of four.
ORDER = 3
CELLS_AT_ONCE = 1 << 14  # at which two surfaces are compared; at least one control face


def fit_patches(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    tolerance: float | None = None,
    normal_tolerance: float | None = None,
    levels: int | None = None,
    force: bool = False,
    fair_tolerance: float | ArrayLike | None = None,
    scan: Mapping[str, Any] | None = None,
    blend: Callable[[Result, int], np.ndarray] | None = None,
    groups: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **options: Any,
) -> SplinePatches:
    """Bicubic B-spline patches of a control mesh's fair surface, ready for CAD (write_step).

    Parameters
    ----------
    vertices, faces
        As those of fair().
    tolerance : float, share of the size
        The farthest that a patch may be from the fair surface: from the refined one, and about that
        from the limit of finer ones, together; the size is the largest extent along an axis. None: a
        ten-thousandth; with a scan half of the distance of 95 % of its points, if that is more.
    normal_tolerance : float, radians
        The sharpest angle between the normals of two patches along an edge that is no crease. None:
        8e-4; with a scan the angle of `tolerance` over a mean control edge, if that is more.
    levels : int
        How often the mesh is refined before patches are fitted. None: 5, or more where a tolerance
        asks for it and the surface stays below 300 000 points, or 1 200 000 where faces miss the
        tolerance; less for very large meshes.
    force : bool
        Return patches also where the refined surface folds or is not resolved. Their input faces
        are in patches.unresolved then.
    fair_tolerance : float or (n,) float, mesh units
        fair()'s own tolerance, with interpolation="approximate".
    scan : dict
        Arguments of fit(), points at least: patches of the surface near that scan, and
        patches.scan_distances. The weight of the first level counts for all.
    blend : callable (Result, level) -> (N, 3) float64
        What patches are fitted to in place of the result's vertices, such as a mix of them with its
        shapes. Called for each surface, at each level; patches.result has the outcome.
    groups : (f,) int
        Faces of different numbers, such as materials, are in different patches.
    threads, progress, monitor, **options
        As those of fair(): energy, creases, boundary and so on.

    Returns
    -------
    SplinePatches
        Where a tolerance could not be met, patches.unmet has the input faces.

    Raises
    ------
    FairingError
        As fair() does. UNRESOLVED where the refined surface folds, or turns by more than 20 degrees
        between two of its faces; `elements` are the input faces there.
    """
    run = _Run(tolerance, normal_tolerance, switch("force", force))
    check_watchers(progress, monitor)
    if fair_tolerance is not None:
        options["tolerance"] = fair_tolerance
    runs = SeveralRuns(progress, monitor, whole("threads", threads))
    points = vertex_array(vertices)
    polygons = face_arrays(faces)
    if groups is not None:
        run.groups = numbers(groups, "groups", "iu").astype(np.int32)
        if run.groups.shape != (len(polygons[1]) - 1,):
            raise fairing_error(
                "BAD_SHAPE",
                f"groups has shape {run.groups.shape}; it must be ({len(polygons[1]) - 1},).",
            )

    given = None if scan is None else dict(scan)

    def surface(level: int, **watchers: Any) -> Result:
        if given is None:
            result = fair(points, polygons, level, **options, **watchers)
        else:
            result = fit(points, polygons, levels=level, **given, **options, **watchers)
            given.update(tolerance=None, weight=result.weight)
            run.allow_for(result, polygons)
        if blend is not None:
            result.vertices = np.ascontiguousarray(blend(result, level), np.float64)
        return result

    if levels is None:
        halves = 1 if options.get("symmetry_plane") is None else 2
        energy = options.get("energy", "thin_plate")

        def count(level: int) -> int:
            return halves * predicted_size(len(points), polygons, level, 0, energy)["vertices"]

        found = _at_own_level(run, surface, count, runs)
    else:
        level = whole("levels", levels)
        if level < 2:
            raise fairing_error("BAD_OPTION", f"levels is {level}; it must be 2 or more, or None.")
        coarser = surface(level - 1, **runs.run(0.0, 0.1))
        result = surface(level, **runs.run(0.1, 0.6))
        run.refuse(run.sharp_faces(result, level, runs.run(0.6, 0.6)))
        error = change_between(coarser, result, level) / ORDER
        found = run.checked(run.fitted(result, level, error, runs.run(0.6, 1.0)))
    runs.finish()
    if given is not None and isinstance(found.result, Fitted):
        off = _on_one_side(np.asarray(given["points"], np.float64), found.result, options)
        found.scan_distances = distances_from(found, off, found.result.faces_of_points)
    return found


def _on_one_side(points: np.ndarray, half: Result, options: Mapping[str, Any]) -> np.ndarray:
    """The points of a scan; with a symmetry_plane, mirrored to the side of `half`."""
    if options.get("symmetry_plane") is None:
        return points
    axis = "xyz".index(options["symmetry_plane"])
    points = points.copy()
    points[:, axis] = np.copysign(points[:, axis], half.vertices[:, axis].sum())
    return points


def _at_own_level(
    run: _Run,
    surface: Callable[..., Result],
    count: Callable[[int], int],
    runs: SeveralRuns,
) -> SplinePatches:
    """Refines the surface (`surface`, with `count` points) until one serves or the next is too large."""
    level = FIRST_LEVEL
    turns = np.empty(0)  # on the previous level
    missing = 0.0
    while level > LEAST_LEVEL and count(level) > MOST_POINTS:
        level -= 1
    done, folds = 0.0, False
    coarser: Result | None = None
    best: SplinePatches | None = None
    finest = _finest(count, level)
    for at in range(level - 1, LAST_LEVEL + 1):
        part = done + 0.4 * (1 - done)
        result = surface(at, **runs.run(done, part))
        done = part
        if at < level:
            coarser = result
            folds = run.stays_folded(result, at, finest - at, runs.run(done, done))
            turns = run.turns(result, at, runs.run(done, done))
            continue
        before, turns = turns, run.turns(result, at, runs.run(done, done))
        if best is not None and not len(best.unresolved) and (turns > TURN_LIMIT).any():
            break  # finer surfaces fold where the previous one does not
        folds = folds or run.stays_sharp(result, at, before, turns, finest - at)
        next_count = inf if folds or at == LAST_LEVEL else count(at + 1)
        assert coarser is not None  # the previous level
        error = change_between(coarser, result, at) / ORDER
        coarser = result
        size = float(np.ptp(result.vertices, axis=0).max(initial=0))
        missing, former = error.max(initial=0) / (run.tolerance * size) if size else 0.0, missing
        # the change falls so slowly at poles of curvature of a thin plate that no level is fine enough
        falling = min(missing / former, 1.0) if former else 1.0 / (1 + ORDER)
        serves = missing * falling ** (finest - at) <= 1.0
        # a surface whose own error exceeds the tolerance is not worth a fit
        most = MOST_POINTS_FOR_FACES if missing > 1.0 and serves else MOST_FINER_POINTS
        if missing > LATTICE_SHARE and next_count <= most:
            continue
        last = next_count > MOST_POINTS_FOR_FACES
        sharp = run.sharp_faces(result, at, runs.run(done, done))
        if sharp and not run.force:  # its patches would be refused
            if not last:
                continue
            if best is None:
                run.refuse(sharp)
            break
        part = 1.0 if last else done + 0.5 * (1 - done)
        # a whole fit is worthwhile only if faces without patches have some now
        folded: ArrayLike = [] if best is None or run.force else best.unresolved.tolist()
        if folded and run.still_folded(result, at, folded, runs.run(done, part)):
            done = part
            if last:
                break
            continue
        found = run.fitted(result, at, error, runs.run(done, part))
        done = part
        if best is None or _faults(found, serves) <= _faults(best, serves):
            best = found
        if last or not any(_faults(found, serves)) or _has_all_spans(found, serves):
            break
    assert best is not None  # the last level is fitted or refused
    return run.checked(best)


def _faults(patches: SplinePatches, serves: bool) -> tuple[int, int]:
    """Numbers of faces that are not resolved, and of faces that miss a tolerance which a finer level
    may meet.
    """
    missing = patches.unmet if serves else patches.unmet_by_fit
    return len(patches.unresolved), len(missing)


def _has_all_spans(patches: SplinePatches, serves: bool) -> bool:
    """Whether no finer level improves the patches that miss a tolerance: the surface is fine enough
    everywhere, or never will be, and a patch has at most 16 spans, of four steps of the lattice each;
    one of a triangle is half as wide. A patch that folds on one level may not fold on the next.
    """
    level = 7 if len(patches.result.faces[0]) else 6
    settled = not len(patches.unresolved) and not (serves and len(patches.unmet_by_surface))
    return patches.levels >= level and settled


def _finest(count: Callable[[int], int], level: int) -> int:
    """The last level for `_at_own_level`."""
    while level < LAST_LEVEL and count(level + 1) <= MOST_POINTS_FOR_FACES:
        level += 1
    return level


class _Run:
    """The settings of fit_patches(), and its fits on a level."""

    def __init__(self, tolerance: object, normal_tolerance: object, force: bool):
        self._has_tolerance = tolerance is not None
        self._has_angle = normal_tolerance is not None
        self.tolerance = USUAL_TOLERANCE if tolerance is None else real("tolerance", tolerance)
        self.normal_tolerance = (
            USUAL_ANGLE if normal_tolerance is None else real("normal_tolerance", normal_tolerance)
        )
        self.force = force
        self.groups = np.empty(0, np.int32)  # of the input's faces
        for name in ("tolerance", "normal_tolerance"):
            if getattr(self, name) <= 0:
                raise fairing_error(
                    "BAD_OPTION", f"{name} is {getattr(self, name)}; it must be greater than 0."
                )

    def allow_for(self, found: Fitted, polygons: tuple[np.ndarray, np.ndarray]) -> None:
        """Allows more near a scan where no tolerance was given. The angle is that of a patch which is off
        by the tolerance over a control edge.
        """
        size = float(np.ptp(found.vertices, axis=0).max(initial=0))
        corners, offsets = polygons
        ends = found.vertices[corners] - found.vertices[corners[following(offsets)]]
        edge = float(np.linalg.norm(ends, axis=1).mean())
        if size and not self._has_tolerance:
            self.tolerance = max(USUAL_TOLERANCE, SHARE_OF_SCAN * found.within[0] / size)
        if edge and not self._has_angle:
            self.normal_tolerance = max(USUAL_ANGLE, self.tolerance * size / edge)

    def fitted(
        self, result: Result, level: int, lattice_error: np.ndarray, watched: dict[str, Any]
    ) -> SplinePatches:
        # reported even if the fit is quick
        if watched["progress"](0.0, "patches") is False:
            watched["monitor"].cancel()
        polygons = control_polygons(result, level)
        arrays, bad = self._fit(
            result.vertices,
            *result.faces,
            result.crease_edges,
            self._groups_of(polygons),
            level,
            **watched,
        )
        arrays.update(
            tolerance=self.tolerance,
            normal_tolerance=self.normal_tolerance,
            lattice_error=lattice_error,
            unresolved=np.unique(polygons[bad]).astype(np.int64),
        )
        return SplinePatches(arrays, result, level)

    def _groups_of(self, polygons: np.ndarray) -> np.ndarray:
        return self.groups[polygons] if len(self.groups) else self.groups

    def _fit(
        self,
        vertices: np.ndarray,
        triangles: np.ndarray,
        quads: np.ndarray,
        creases: np.ndarray,
        groups: np.ndarray,
        level: int,
        threads: int,
        monitor: _native.Monitor,
        progress: Progress,
    ) -> tuple[dict[str, Any], np.ndarray]:
        """The core's arrays, and (F,) bool: control faces whose patches or surface fold."""
        arrays = _native.fit_splines(
            vertices,
            triangles,
            quads,
            creases,
            groups,
            level,
            self.tolerance,
            self.normal_tolerance,
            threads,
            monitor,
            progress,
        )
        bad = (arrays["lattice_turn"] > TURN_LIMIT) | (arrays["face_angle"] > TURN_LIMIT)
        folded = np.repeat(~(arrays["turned"] <= FOLD_LIMIT), np.diff(arrays["patch_face_offsets"]))
        bad[arrays["patch_faces"][folded]] = True
        return arrays, bad

    def still_folded(
        self, result: Result, level: int, faces: ArrayLike, watched: dict[str, Any]
    ) -> bool:
        """Whether patches of the input `faces`, fitted with their neighbours alone, still fold."""
        polygons = control_polygons(result, level)
        chosen = np.isin(polygons, faces)
        part = around(result, level, chosen)
        if len(part.control_faces) == len(polygons):
            return False  # as far as is known; the whole fit decides
        chosen_of_part = chosen[part.control_faces]
        groups = self._groups_of(polygons[part.control_faces])
        _, bad = self._fit(*part.arrays, groups, level, **watched)
        return bool(bad[chosen_of_part].any())

    def stays_folded(self, result: Result, level: int, finer: int, watched: dict[str, Any]) -> bool:
        """Whether folds will remain on the finest level, since turns halve from level to level; then it
        is refused.
        """
        limit = min(HOPELESS_TURN, 1.5 * TURN_LIMIT * 2**finer)
        turns = _native.lattice_turns(
            result.vertices, *result.faces, result.crease_edges, level, 0.0, **watched
        )
        bad = turns > limit
        self.refuse(np.unique(control_polygons(result, level)[bad]).tolist())
        return bool(bad.any())

    def turns(self, result: Result, level: int, watched: dict[str, Any]) -> np.ndarray:
        """(F,) the largest turn of each control face that exceeds the tolerance."""
        least = self.tolerance * float(np.ptp(result.vertices, axis=0).max(initial=0))
        return _native.lattice_turns(
            result.vertices, *result.faces, result.crease_edges, level, least, **watched
        )

    def stays_sharp(
        self, result: Result, level: int, before: np.ndarray, turns: np.ndarray, finer: int
    ) -> bool:
        """Whether turns above the limit decrease so slowly, from the previous level to this, that they
        stay above it on the finest. It is refused then, unless forced.
        """
        bad = np.minimum(before, turns) > TURN_LIMIT
        falling = np.minimum(turns[bad] / before[bad], 1.0)
        bad[bad] = turns[bad] * falling**finer > TURN_LIMIT
        self.refuse(np.unique(control_polygons(result, level)[bad]).tolist())
        return bool(bad.any())

    def sharp_faces(self, result: Result, level: int, watched: dict[str, Any]) -> list[int]:
        """Faces whose refined surface folds or turns too sharply for any patch."""
        turns = self.turns(result, level, watched)
        return np.unique(control_polygons(result, level)[turns > TURN_LIMIT]).tolist()

    def checked(self, patches: SplinePatches) -> SplinePatches:
        self.refuse(patches.unresolved.tolist())
        return patches

    def refuse(self, faces: list[int]) -> None:
        if faces and not self.force:
            raise fairing_error(
                "UNRESOLVED",
                "{face} {has|have} a surface that folds or turns too sharply for patches.",
                faces,
                "face",
                "Move or add control vertices, crease the edges there, or give force=True.",
            )


@dataclass(frozen=True)
class _Part:
    """A subset of a refined surface's control faces, as a separate surface."""

    control_faces: np.ndarray  # (K,) ids in the whole surface
    arrays: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]  # arguments of fit_splines()


def around(result: Result, level: int, chosen: np.ndarray) -> _Part:
    """The control faces of the mask `chosen` (F,) and all that share a vertex with them."""
    cells = 4**level
    blocks = [faces.reshape(-1, cells * faces.shape[1]) for faces in result.faces]
    masks = chosen[: len(blocks[0])], chosen[len(blocks[0]) :]
    touched = np.zeros(len(result.vertices), bool)
    for block, mask in zip(blocks, masks):
        touched[block[mask]] = True
    kept = [touched[block].any(axis=1) for block in blocks]
    used = np.zeros_like(touched)
    for block, keep in zip(blocks, kept):
        used[block[keep]] = True
    number = np.cumsum(used, dtype=np.int32) - 1
    triangles, quads = (
        number[block[keep]].reshape(-1, corners)
        for block, keep, corners in zip(blocks, kept, (3, 4))
    )
    creases = result.crease_edges
    creases = number[creases[used[creases].all(axis=1)]]
    return _Part(
        np.flatnonzero(np.concatenate(kept)),
        (result.vertices[used], triangles, quads, creases),
    )


def change_between(coarse: Result, fine: Result, levels: int) -> np.ndarray:
    """(F,) float64: for each control face, the largest distance, along normals, between the surfaces of
    `levels` and of one level less, at common points; mesh units. Computed in blocks of control faces.
    """
    cells = 4**levels
    found = np.zeros(sum(map(len, fine.faces)) // cells)
    begin = 0  # of the triangles, then of the quads
    for corners, few, many in zip((3, 4), coarse.faces, fine.faces):
        few, many = few.reshape(-1, cells // 4, corners), many.reshape(-1, cells, corners)
        shared = _all_cells(corners, 2**levels), _even_cells(corners, 2**levels)
        at_once = max(1, CELLS_AT_ONCE // cells)
        own = found[begin : begin + len(few)]
        begin += len(few)
        for first in range(0, len(few), at_once):
            part = slice(first, first + at_once)
            points = coarse.vertices[few[part, shared[0], 0]]
            own[part] = _distances(points, fine.vertices, many[part, shared[1]]).max(axis=1)
    return found


def _distances(points: np.ndarray, vertices: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Distance of each point from the plane at its cell's first corner."""
    a, b, c = (vertices[cells[:, :, k]] for k in (0, 1, -1))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=2)
    gap = np.einsum("fck,fck->fc", a - points, normal)
    return np.abs(gap) / np.where(length > 0, length, inf)


def _rows(corners: int, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Column i and row j of the first corner of each cell of a face with `n` steps a side."""
    j, i = np.divmod(np.arange(n * n), n)
    kept = i + j < n if corners == 3 else np.ones(n * n, bool)
    return i[kept], j[kept]


def _cell(corners: int, n: int, i: np.ndarray, j: np.ndarray) -> np.ndarray:
    return n * n - (n - j) ** 2 + 2 * i if corners == 3 else n * j + i


def _all_cells(corners: int, n: int) -> np.ndarray:
    return _cell(corners, n // 2, *_rows(corners, n // 2))


def _even_cells(corners: int, n: int) -> np.ndarray:
    i, j = _rows(corners, n // 2)
    return _cell(corners, n, 2 * i, 2 * j)
