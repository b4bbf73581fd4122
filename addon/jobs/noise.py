# SPDX-License-Identifier: GPL-3.0-or-later
"""Smooths a measured patch: the surface passes near its vertices, with a weight that depends on their
noise, and the vertices move to it along their normals.

A smoothing spline [Reinsch 1967] on the mesh itself, with its amount by generalized cross-validation
[Craven, Wahba 1979; Golub, Heath, Wahba 1979]. Plain arrays, no Blender.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import core
from ..transfer.cut_out import CutOut, cut_out, grown
from ..triangles import fans, marked, normals

# Weights to try, from strong to weak: 10 hardly smooths, 1e-4 leaves a plate. Between neighbouring
# weights the least error of a noisy sphere differs by at most a fifth.
_WEIGHTS = 10.0 ** np.arange(1.0, -4.1, -0.5)
# the weight for the normals along which noise is measured: between the extremes
_FIRST = 10.0**-0.5
# faces on which the amount is found; more give the same amount
SAMPLE = 8_000
# Faces that are smoothed at a time. One solve is direct, and its time grows with the power 1.5:
# processor time a vertex is 16 µs for 4,000 of them, 25 for 23,000 and 68 for 90,000; smaller blocks
# consist mostly of borders.
BLOCK = 10_000
# Width of the overlap around a block in mean edges, times the weight to the power -¼, which is the
# reach of the fit in edges. At six times the reach the block's border changes a vertex by at most 0.017
# of the noise, 0.002 rms.
_AROUND = 6.0
_SOUGHT = 0.2  # share of the progress until the amount is known


def sample(arrays: core.ControlArrays, chosen: np.ndarray) -> np.ndarray:
    """(m,) bool: a connected part of the faces `chosen`, (m,) bool, to find the amount on."""
    found = marked(np.flatnonzero(chosen)[:1], len(chosen))
    while found.sum() < SAMPLE:
        more = grown(arrays, found, 1) & chosen
        if (more == found).all():
            # another part, with all its neighbours
            rest = np.flatnonzero(chosen & ~found)[:1]
            if not len(rest):
                break
            more[rest] = True
        found = more
    return found


@dataclass(frozen=True)
class Amount:
    weight: float
    noise: float  # rms along the normals, a length


def amount(arguments: Mapping[str, Any], free: np.ndarray, noise: float, runs: Any) -> Amount:
    """How strongly the vertices `free`, (n,) bool, are to attract the surface. `arguments`: those of
    discrete_fairing.fair; all other vertices stay.

    `noise`: rms distance of the free vertices from the true surface, a length; 0: estimated.
    """
    trial = _Trial(_Fit(arguments, free, runs.run(0.0, _SOUGHT)), free)
    weight = trial.for_noise(noise) if noise > 0 else trial.by_validation()
    return Amount(weight, trial.noise(weight))


def smoothed(
    arrays: core.ControlArrays,
    arguments_of: Callable[[core.ControlArrays], Mapping[str, Any]],
    free: np.ndarray,
    weight: float,
    runs: Any,
) -> Any:
    """The Result at level 0 for `arrays`, whose `free` vertices, (n,) bool, move along the normals to
    the surface attracted with `weight`. Vertices on creases stay.

    Computed in blocks, since the surface near a vertex depends on the data around it only.
    `arguments_of`: makes the arguments of discrete_fairing.fair for a part; `runs`: SeveralRuns of the
    package.
    """
    whole = dict(arguments_of(arrays)) | {"levels": 0, "interpolation": "exact"}
    for name in ("region", "joint", "shapes", "normals", "weights"):
        whole.pop(name, None)
    result = core.module().fair(**whole | runs.run(_SOUGHT, _SOUGHT))
    points = np.asarray(whole["vertices"], float)
    faces = free[arrays.corners]
    faces = np.logical_or.reduceat(faces, arrays.offsets[:-1]) if len(faces) else np.zeros(0, bool)
    around = _AROUND * weight**-0.25 * arrays.mean_edge_length
    done, count = 0, max(int(faces.sum()), 1)
    for part, own in blocks(arrays, faces, BLOCK, around):
        begin, done = done, done + int(own.sum())
        span = [_SOUGHT + (1 - _SOUGHT) * share / count for share in (begin, done)]
        fit = _Fit(arguments_of(part.arrays), free[part.vertices], runs.run(*span))
        surface = fit.own(fit.run(weight).vertices)
        along = fit.normals(surface)
        off = np.einsum("ij,ij->i", surface - fit.points, along)[:, None] * along
        mine = marked(
            part.arrays.corners[np.repeat(own, part.arrays.face_sizes)], len(part.vertices)
        )
        mine &= free[part.vertices]
        rows = part.vertices[mine]
        result.vertices[rows] = points[rows] + off[mine]
    return result


class _Fit:
    def __init__(
        self, arguments: Mapping[str, Any], free: np.ndarray, watchers: dict[str, Any]
    ) -> None:
        given = dict(arguments) | {"levels": 0, "interpolation": "approximate", "pad_size": 0.0}
        given |= {"energy": "thin_plate", "tension": 0.0, "tolerance": 0.0}
        for name in ("region", "joint", "shapes", "normals", "weights"):
            given.pop(name, None)
        self._arguments, self._free, self._watchers = given, free, watchers
        self.points = np.asarray(given["vertices"], float)
        corners, offsets = given["faces"]
        self._triangles = corners[fans(offsets[:-1], np.diff(offsets))[0]]

    def run(self, weight: float, **more: Any) -> Any:
        weights = np.where(self._free, weight, np.inf)
        return core.module().fair(**self._arguments | more | self._watchers, weights=weights)

    def own(self, points: np.ndarray) -> np.ndarray:
        """The points of the vertices, without the centres of polygons that the core has split."""
        return points[: len(self.points)]

    def normals(self, points: np.ndarray) -> np.ndarray:
        total = normals(points, self._triangles)
        return total / np.maximum(np.linalg.norm(total, axis=1), 1e-300)[:, None]


class _Trial:
    """The noise that remains with one weight."""

    def __init__(self, fit: _Fit, free: np.ndarray):
        first = fit.own(fit.run(_FIRST).vertices)
        self._fit, self._normals = fit, fit.normals(first)
        # without vertices on creases, which stay
        self._free = free & (first != fit.points).any(axis=1)
        signs = np.random.default_rng(0).choice([-1.0, 1.0], len(free)) * self._free
        # a probe of any size, since the fit is linear
        size = 1e-3 * float(np.ptp(fit.points, axis=0).max(initial=0.0)) or 1.0
        self._probe = size * signs[:, None] * self._normals
        self._known: dict[float, tuple[float, float]] = {}

    def _measured(self, weight: float) -> tuple[float, float]:
        """The mean square distance from the fit, and its trace by a probe [Hutchinson 1990]."""
        if weight not in self._known:
            found = self._fit.run(weight, shapes=(self._fit.points + self._probe)[None])
            surface, probed = self._fit.own(found.vertices), self._fit.own(found.shapes[0])
            off = np.einsum("ij,ij->i", surface - self._fit.points, self._normals)[self._free]
            answer = np.einsum("ij,ij->", probed - surface, self._probe)
            whole = float((self._probe**2).sum())
            self._known[weight] = (
                (float((off**2).mean()), float(answer) / whole) if whole else (0.0, 0.0)
            )
        return self._known[weight]

    def _off(self, weight: float) -> float:
        return float(np.sqrt(self._measured(weight)[0]))

    def noise(self, weight: float) -> float:
        square, share = self._measured(weight)
        return float(np.sqrt(square / max(1.0 - share, 1e-9)))

    def by_validation(self) -> float:
        scores: list[float] = []
        for weight in _WEIGHTS.tolist():
            square, share = self._measured(weight)
            scores.append(square / (1.0 - share) ** 2)
            if len(scores) > 2 and scores[-1] > scores[-2] > min(scores):
                break
        return float(_WEIGHTS[int(np.argmin(scores))])

    def for_noise(self, noise: float) -> float:
        """The strongest weight that removes so much noise [Morozov 1966]."""
        tried = [*(10.0 ** np.arange(3.0, 1.0, -0.5)).tolist(), *_WEIGHTS.tolist()]
        low = next((w for w in tried if self._off(w) >= noise), tried[-1])
        high = low * 10.0**0.5
        for _ in range(4):
            middle = float(np.sqrt(low * high))
            low, high = (middle, high) if self._off(middle) >= noise else (low, middle)
        return low


def blocks(
    arrays: core.ControlArrays, chosen: np.ndarray, most: int, around: float
) -> Iterator[tuple[CutOut, np.ndarray]]:
    """(cut-out, (f,) bool: whether a face is the block's own): together the own faces are the faces
    `chosen` (m,) bool, at most `most` a block. A cut-out also has all faces whose centres are within
    `around`, a length, of the bounding box of its own.

    Blocks are halved across the longest axis, recursively, so that no step reads more than it divides.
    """
    whole = CutOut(arrays, np.arange(len(arrays.positions)), np.arange(len(chosen)))
    waiting = [(whole, chosen)] if chosen.any() else []
    while waiting:
        part, own = waiting.pop()
        if own.sum() <= most:
            yield part, own
            continue
        centres = core.measured(part.arrays).face_centres
        rows = np.flatnonzero(own)
        axis = int(np.argmax(np.ptp(centres[rows], axis=0)))
        order = rows[np.argsort(centres[rows, axis], kind="stable")]
        for half in (order[len(order) // 2 :], order[: len(order) // 2]):
            waiting.append(_cut(part, centres, half, around))


def _cut(
    part: CutOut, centres: np.ndarray, rows: np.ndarray, around: float
) -> tuple[CutOut, np.ndarray]:
    low, high = centres[rows].min(axis=0) - around, centres[rows].max(axis=0) + around
    near = ((centres >= low) & (centres <= high)).all(axis=1)
    found = cut_out(part.arrays, near)
    own = marked(rows, len(near))
    whole = CutOut(found.arrays, part.vertices[found.vertices], part.faces[found.faces])
    return whole, own[found.faces]
