# SPDX-License-Identifier: GPL-3.0-or-later
"""Smooths a measured patch: the surface passes near its vertices, with a weight that depends on their
noise, and the vertices move to it along their normals.

A smoothing spline [Reinsch 1967] on the mesh itself, with its amount by generalized cross-validation
[Craven, Wahba 1979; Golub, Heath, Wahba 1979]. Plain arrays, no Blender.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import core
from ..transfer.cut_out import grown
from ..triangles import fans, marked, normals, unit

# Weights to try, from strong to weak: 10 hardly smooths, 1e-4 leaves a plate. Between neighbouring
# weights the least error of a noisy sphere differs by at most a fifth.
_WEIGHTS = 10.0 ** np.arange(1.0, -4.1, -0.5)
# the weight for the normals along which noise is measured: between the extremes
_FIRST = 10.0**-0.5
# faces on which the amount is found; more give the same amount
SAMPLE = 8_000
# Faces that are smoothed at a time. One solve is direct, and its time grows with the power 1.5:
# processor time a vertex is 16 µs for 4,000 of them, 25 for 23,000 and 68 for 90,000; smaller pieces
# consist mostly of borders.
PIECE = 10_000
# Rings around a piece, times the weight to the power -¼, which is the reach of the fit in edges. At six
# times the reach the piece's border changes a vertex by at most 0.017 of the noise, 0.002 rms.
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


def smoothed(arguments: Mapping[str, Any], free: np.ndarray, weight: float, runs: Any) -> Any:
    """The Result at level 0 for `arguments`, those of discrete_fairing.fair, whose `free` vertices, (n,) bool, move
    along the normals to the surface attracted with `weight`. Vertices on creases stay.

    Computed in pieces, since the surface near a vertex depends on the data around it only. `runs`: SeveralRuns of the
    package.
    """
    fit = _Fit(arguments, free, {})
    parts = fit.pieces(weight)
    spans = np.linspace(_SOUGHT, 1.0, len(parts) + 1)
    made = [part.fair(**runs.run(*span)) for part, span in zip(parts, zip(spans, spans[1:]))]
    result = core.module().join(made)
    surface = fit.own(result.vertices)
    along = fit.normals(surface)
    off = np.einsum("ij,ij->i", surface - fit.points, along)[:, None] * along
    surface[:] = np.where(free[:, None], fit.points + off, fit.points)
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
        given = self._arguments | more | self._watchers
        return core.module().fair(**given, weights=self._weights(weight))

    def pieces(self, weight: float) -> list[Any]:
        """Pieces of at most PIECE faces, with as many rings around as the fit reaches."""
        given = {k: v for k, v in self._arguments.items() if k not in ("threads", "memory_limit")}
        count = -(-(len(given["faces"][1]) - 1) // PIECE)
        rings = int(np.ceil(_AROUND * weight**-0.25))
        weights = self._weights(weight)
        return core.module().pieces(**given, weights=weights, count=count, rings=rings)

    def _weights(self, weight: float) -> np.ndarray:
        return np.where(self._free, weight, np.inf)

    def own(self, points: np.ndarray) -> np.ndarray:
        """The points of the vertices, without the centres of polygons that the core has split."""
        return points[: len(self.points)]

    def normals(self, points: np.ndarray) -> np.ndarray:
        return unit(normals(points, self._triangles))


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
