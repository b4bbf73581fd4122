# SPDX-License-Identifier: GPL-3.0-or-later
"""The level on which a surface serves for patches."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from ..errors import fairing_error
from ..level_change import change_between
from ..result import Result
from ..watching import SeveralRuns
from .fits import PatchFits
from .patches import SplinePatches

FIRST_LEVEL, LAST_LEVEL, LEAST_LEVEL = 5, 8, 3
# Largest numbers of points: of the first surface, of a finer one that converges better, and of one
# whose patches must meet a tolerance.
MOST_POINTS, MOST_FINER_POINTS, MOST_POINTS_FOR_FACES = 6_000_000, 300_000, 1_200_000
# The error of the refined surface itself, as a share of the tolerance.
LATTICE_SHARE = 0.5
# The change to the next level over the sum of all later changes, which fall by a factor of four.
ORDER = 3


def at_level(
    fits: PatchFits,
    surface: Callable[..., Result],
    level: int,
    runs: SeveralRuns,
    coarser_levels: int,
) -> SplinePatches:
    """Patches of the surface of this level; folds are looked for on so many coarser levels first."""
    if level < 2:
        raise fairing_error("BAD_OPTION", f"levels is {level}; it must be 2 or more, or None.")
    done = 0.0
    for at in range(max(level - coarser_levels, min(LEAST_LEVEL, level - 1)), level):
        part = _part_at(at, level)
        coarser = surface(at, **runs.run(done, part))
        done = part
        if at >= LEAST_LEVEL:
            fits.stays_folded(coarser, at, inf, runs.run(done, done))
    result = surface(level, **runs.run(done, 0.6))
    turns = fits.turns(result, level, runs.run(0.6, 0.6))
    fits.refuse(fits.sharp_faces(result, level, turns))
    error = change_between(coarser, result, level) / ORDER
    return fits.checked(fits.fitted(result, level, error, runs.run(0.6, 1.0)))


def at_own_level(
    fits: PatchFits,
    surface: Callable[..., Result],
    count: Callable[[int], int],
    runs: SeveralRuns,
    coarser_levels: int,
) -> SplinePatches:
    """Refines the surface (`surface`, with `count` points) until its patches serve, the next one is too
    large, or finer ones cannot halve the largest miss. The changes on so many coarser levels tell that.
    """
    level = FIRST_LEVEL
    turns = np.empty(0)  # on the previous level
    missing = 0.0
    while level > LEAST_LEVEL and count(level) > MOST_POINTS:
        level -= 1
    done, folds = 0.0, False
    coarser: Result | None = None
    best: SplinePatches | None = None
    finest = _finest(count, level)
    for at in range(level - coarser_levels, LAST_LEVEL + 1):
        part = _part_at(at, level) if at < level else done + 0.4 * (1 - done)
        result = surface(at, **runs.run(done, part))
        done = part
        error = np.zeros(0) if coarser is None else change_between(coarser, result, at) / ORDER
        coarser = result
        size = float(np.ptp(result.vertices, axis=0).max(initial=0))
        missing, former = error.max(initial=0) / (fits.tolerance * size) if size else 0.0, missing
        if at < level:
            # before the next level is solved, which takes much longer
            if at >= min(LEAST_LEVEL, level - 1):
                finer = finest - at if at == level - 1 else inf
                folds = fits.stays_folded(result, at, finer, runs.run(done, done))
                turns = fits.turns(result, at, runs.run(done, done))
            continue
        before, turns = turns, fits.turns(result, at, runs.run(done, done))
        sharp = fits.sharp_faces(result, at, turns)
        if sharp and best is not None and not len(best.unresolved):
            break  # finer surfaces fold where the previous one does not
        folds = folds or fits.stays_sharp(result, at, before, turns, finest - at)
        next_count = inf if folds or at == LAST_LEVEL else count(at + 1)
        # the change falls so slowly at poles of curvature of a thin plate that no level is fine enough
        falling = min(missing / former, 1.0) if former else 1.0 / (1 + ORDER)
        ahead = missing * falling ** (finest - at)
        # a surface whose own error exceeds the tolerance is not worth a fit, if a finer one halves it
        most = MOST_POINTS_FOR_FACES if missing > 1.0 else MOST_FINER_POINTS
        if missing > LATTICE_SHARE and 2 * ahead <= missing and next_count <= most:
            continue
        last = next_count > MOST_POINTS_FOR_FACES
        if sharp and not fits.force:  # its patches would be refused
            if not last:
                continue
            if best is None:
                fits.refuse(sharp)
            break
        part = 1.0 if last else done + 0.5 * (1 - done)
        # a whole fit is worthwhile only if faces without patches have some now
        folded: ArrayLike = [] if best is None or fits.force else best.unresolved.tolist()
        if folded and fits.still_folded(result, at, folded, runs.run(done, part)):
            done = part
            if last:
                break
            continue
        found = fits.fitted(result, at, error, runs.run(done, part))
        done = part
        if best is None or _faults(found) <= _faults(best):
            best = found
        if last or not _may_halve(found, ahead) or _has_all_spans(found, ahead <= 1.0):
            break
    assert best is not None  # the last level is fitted or refused
    return fits.checked(best)


def _faults(patches: SplinePatches) -> tuple[int, float]:
    """The number of faces that are not resolved, and the largest miss."""
    return len(patches.unresolved), patches.largest_miss


def _may_halve(patches: SplinePatches, ahead: float) -> bool:
    """Whether finer levels may resolve faces, meet the tolerance, or halve the largest miss."""
    least = 0.5 if ahead <= 1.0 else ahead + 1.0
    return len(patches.unresolved) > 0 or patches.largest_miss > 2 * least


def _has_all_spans(patches: SplinePatches, serves: bool) -> bool:
    """Whether no finer level improves the patches that miss a tolerance: the surface is fine enough
    everywhere, or never will be, and a patch has at most 16 spans, of four steps of the lattice each;
    one of a triangle is half as wide. A patch that folds on one level may not fold on the next.
    """
    level = 7 if len(patches.result.faces[0]) else 6
    settled = not len(patches.unresolved) and not (serves and len(patches.unmet_by_surface))
    return patches.levels >= level and settled


def _part_at(at: int, level: int) -> float:
    """The progress after a level coarser than `level`: each takes four times as long as the last one."""
    return 0.4 * 4.0 ** (at - level)


def _finest(count: Callable[[int], int], level: int) -> int:
    """The last level for `at_own_level`."""
    while level < LAST_LEVEL and count(level + 1) <= MOST_POINTS_FOR_FACES:
        level += 1
    return level
