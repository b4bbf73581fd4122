# SPDX-License-Identifier: GPL-3.0-or-later
"""denoise(): the noise taken off a whole scan, as much of it at each vertex as the scan there allows.

Vertices move along their normals. The heights h minimize |h|² + t |K (x + h n)·n|², with K what a
vertex is off the mean of its neighbours: a smoothing spline [Reinsch 1967] in its simplest form. For
some amounts t the risk, the mean square error around a vertex, is estimated without bias [Stein 1981],
and the amounts are weighed by it [Leung, Barron 2006]: much is taken off where the shape is smooth,
little where it has details, and hardly any beside sharp edges.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .arrays import face_arrays, vertex_array
from .errors import fairing_error

# Amounts: from next to nothing, and a fifth of the noise, to what is smooth over six edges.
_AMOUNTS = np.append(1e-3, 4.0 ** np.arange(-1, 6))
# Averages over neighbours by which the risk around a vertex is known: of 58 vertices of a mesh of
# triangles. Errors over the noise, with 6 and 16: bust 0.39, 0.35; casting 0.49, 0.46.
_AVERAGES = 16
# A spike: off what is around it by more standard deviations than chance makes in a million vertices,
# and by four times what its neighbours are. Of 60 spikes of 1.5 mm in noise of 0.15 it finds 58, on casting and bust.
_SPIKE, _OVER_NEIGHBOURS = 5.0, 4.0
_STEPS, _RESIDUAL = 40, 0.05  # of conjugate gradients: at most, and what they may leave
_CORNER = 2 * np.sin(np.pi / 8)  # two sides that turn by 45° are so far apart, over their length
_OF_MEDIAN = 1.4826022185056018  # a normal deviation, over the median of its size


class Denoised:
    """A mesh of n vertices without its noise.

    vertices: (n, 3) float64, mesh units, the new positions.
    moves: (n,) float64, mesh units, how far each vertex has moved, along its normal.
    noise: float, mesh units: root mean square distance of a vertex from the surface.
    rejected: (k,) int64, spikes, the worst first: their places are told from their neighbours alone.
    """

    def __init__(
        self, points: np.ndarray, moves: np.ndarray, noise: float, rejected: np.ndarray
    ) -> None:
        self.vertices = points + moves
        self.moves = np.linalg.norm(moves, axis=1)
        self.noise = noise
        self.rejected = rejected

    def __repr__(self) -> str:
        return f"Denoised({len(self.moves)} vertices, noise {self.noise:.3g}, {len(self.rejected)} spikes)"


def denoise(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    *,
    amount: float | None = None,
    fixed: ArrayLike | None = None,
) -> Denoised:
    """Take the noise off a scan: fast, by a linear filter whose strength is chosen vertex by vertex.

    Parameters
    ----------
    vertices, faces
        As of fair(); the mesh may have any defects but faces without area everywhere.
    amount
        Mesh units, over 0: how far vertices are off the surface, root mean square. None: read from
        the vertices. More takes more off.
    fixed
        (n,) bool: vertices that stay.

    Raises
    ------
    FairingError
        BAD_OPTION for an amount that is no length, and bools of another shape; as fair() for arrays.
    """
    points = vertex_array(vertices)
    corners, offsets = face_arrays(faces)
    stays = _fixed(fixed, len(points))
    if amount is not None and not _is_length(amount):
        raise fairing_error("BAD_OPTION", f"amount is {amount!r}; it must be a length over 0.")
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
        raise fairing_error(
            "INDEX_OUT_OF_RANGE", f"A face has a vertex that is none of {len(points)}."
        )
    if not len(corners):
        return Denoised(points, np.zeros_like(points), 0.0, np.empty(0, np.int64))
    stars = _Stars(len(points), corners, offsets)
    calm = 0.5 * (points + stars.mean(points))
    normals = _normals(calm - points.mean(axis=0), corners, offsets)
    off = np.einsum("ij,ij->i", points - stars.mean(points), normals)
    stays |= (stars.counts == 0) | stars.corners(points)
    heights = _Heights(stars, off, stays)
    noise = heights.noise() if amount is None else float(amount)
    if not noise > 0:
        return Denoised(points, np.zeros_like(points), 0.0, np.empty(0, np.int64))
    spikes = heights.reject(noise)
    return Denoised(points, heights.weighed(noise)[:, None] * normals, noise, spikes)


def _is_length(amount: object) -> bool:
    number = isinstance(amount, (int, float, np.number)) and not isinstance(amount, bool)
    return number and 0 < float(amount) < np.inf  # type: ignore[arg-type]


def _fixed(fixed: ArrayLike | None, count: int) -> np.ndarray:
    if fixed is None:
        return np.zeros(count, bool)
    stays = np.asarray(fixed)
    if stays.shape != (count,) or stays.dtype != bool:
        raise fairing_error("BAD_OPTION", f"fixed must be {count} bools, one a vertex.")
    return stays


class _Stars:
    """The neighbours of each vertex: all, and on a border those along it."""

    def __init__(self, count: int, corners: np.ndarray, offsets: np.ndarray) -> None:
        following = np.arange(1, len(corners) + 1)
        following[offsets[1:] - 1] = offsets[:-1]
        sides = np.sort(np.stack([corners, corners[following]], axis=1), axis=1)
        keys, uses = np.unique(sides[:, 0] * count + sides[:, 1], return_counts=True)
        edges = np.stack([keys // count, keys % count], axis=1)
        border = uses == 1
        on_border = np.zeros(count, bool)
        on_border[edges[border].ravel()] = True
        self.on_border = on_border
        start, end = np.concatenate([edges, edges[:, ::-1]]).T
        counts = ~on_border[start] | np.tile(border, 2)
        start, end = start[counts], end[counts]
        order = np.argsort(start, kind="stable")
        self._from_of, self._to = start[order], end[order]
        self.counts = np.bincount(start, minlength=count)
        # transposed: the same pairs by their ends
        back = np.argsort(end, kind="stable")
        self._from, ends = start[back], np.bincount(end, minlength=count)
        self._rows, self._first = self._spans(self.counts)
        self._columns, self._first_back = self._spans(ends)
        self.shares = 1.0 / np.maximum(self.counts, 1)

    @staticmethod
    def _spans(counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rows = np.flatnonzero(counts)
        return rows, (np.cumsum(counts) - counts)[rows]

    def _sums(self, values: np.ndarray, rows: np.ndarray, first: np.ndarray) -> np.ndarray:
        out = np.zeros((len(self.counts), *values.shape[1:]))
        if len(rows):
            out[rows] = np.add.reduceat(values, first, axis=0)
        return out

    def mean(self, values: np.ndarray) -> np.ndarray:
        """Of the neighbours; (n,) or (n, k). Its own where a vertex has none."""
        found = self._sums(values[self._to], self._rows, self._first)
        found *= self.shares.reshape(-1, *[1] * (values.ndim - 1))
        found[self.counts == 0] = values[self.counts == 0]
        return found

    def corners(self, points: np.ndarray) -> np.ndarray:
        """(n,) bool: where a border turns by more than a right angle's half."""
        lengths = np.linalg.norm(points[self._to] - points[self._from_of], axis=1)
        both = self._sums(lengths, self._rows, self._first)
        bent = 2 * np.linalg.norm(self.off_mean(points), axis=1)
        # of two sides of equal length
        return self.on_border & ((self.counts != 2) | (bent > _CORNER * both / 2))

    def off_mean(self, values: np.ndarray) -> np.ndarray:
        """K: what values are off the mean of their neighbours."""
        return values - self.mean(values)

    def transposed(self, values: np.ndarray) -> np.ndarray:
        """K'."""
        shares = (self.counts > 0) * 1.0
        columns = [1] * (values.ndim - 1)
        given = values * self.shares.reshape(-1, *columns)
        found = self._sums(given[self._from], self._columns, self._first_back)
        return values * shares.reshape(-1, *columns) - found

    def squares(self) -> np.ndarray:
        """The diagonal of K'K."""
        return (self.counts > 0) + self._sums(
            self.shares[self._from] ** 2, self._columns, self._first_back
        )

    def averaged(self, values: np.ndarray) -> np.ndarray:
        for _ in range(_AVERAGES):
            values = 0.5 * (values + self.mean(values))
        return values


class _Heights:
    """Heights along the normals of vertices that are `off` the mean of their neighbours."""

    def __init__(self, stars: _Stars, off: np.ndarray, fixed: np.ndarray) -> None:
        self._stars, self._off, self._free = stars, off, (~fixed).astype(float)
        self._data = np.ones(len(off))  # 0: rejected
        self._signs = np.random.default_rng(0).choice([-1.0, 1.0], len(off))  # [Hutchinson 1990]
        self._squares = stars.squares()

    def noise(self) -> float:
        """By the median of what is off twice and thrice, over what a unit of noise would be off: details
        and spikes are in few vertices, and a shape adds to both.
        """
        free = self._free > 0
        if not free.any():
            return 0.0
        unit, off, found = self._stars.off_mean(self._signs), self._off, []
        for _ in range(2):
            unit, off = self._stars.off_mean(unit), self._stars.off_mean(off)
            size = np.sqrt(np.mean(unit[free] ** 2))
            found.append(_OF_MEDIAN * np.median(np.abs(off[free])) / size if size > 0 else 0.0)
        return float(min(found))

    def _solve(self, amount: float, start: np.ndarray | None) -> np.ndarray:
        """(n, 2): the heights, and what the signs would leave as data. Conjugate gradients on the diagonal."""
        stars, data, free = self._stars, self._data[:, None], self._free[:, None]
        wanted = np.stack([-amount * stars.transposed(self._off), self._data * self._signs], axis=1)
        inverse = free / (data + amount * self._squares[:, None])

        def multiply(values: np.ndarray) -> np.ndarray:
            return data * values + amount * stars.transposed(stars.off_mean(values))

        found = np.zeros((len(self._off), 2)) if start is None else start.copy()
        left = free * (wanted - multiply(found))
        scaled = inverse * left
        ahead, energy = scaled.copy(), (left * scaled).sum(0)
        least = _RESIDUAL**2 * (wanted * inverse * wanted).sum(0)
        for _ in range(_STEPS):
            if (energy <= least).all():
                break
            product = free * multiply(ahead)
            step = energy / np.maximum((ahead * product).sum(0), 1e-300)
            found += step * ahead
            left -= step * product
            scaled = inverse * left
            now = (left * scaled).sum(0)
            ahead = scaled + now / np.maximum(energy, 1e-300) * ahead
            energy = now
        return found

    def reject(self, noise: float) -> np.ndarray:
        """Spikes, the worst first: from here on they are no data. None on a border, where two neighbours
        tell too little.
        """
        found = self._solve(1.0, None)
        kept = (self._free > 0) & ~self._stars.on_border
        share = float((found[kept, 1] * self._signs[kept]).mean()) if kept.any() else 0.0
        sizes = np.abs(found[:, 0]) / (noise * max(1.0 - share, 1e-9))
        beside = _OVER_NEIGHBOURS * self._stars.mean(sizes)
        spikes = np.flatnonzero((sizes > np.maximum(_SPIKE, beside)) & kept)
        self._data[spikes] = 0.0
        return spikes[np.argsort(-sizes[spikes], kind="stable")]

    def weighed(self, noise: float) -> np.ndarray:
        """(n,): the heights of all amounts, each by how near it is to the truth around a vertex."""
        counted = self._data * self._free
        some = self._stars.averaged(counted)
        heights, risks, found = [], [], None
        for amount in _AMOUNTS.tolist():
            found = self._solve(amount, found)
            share = found[:, 1] * self._signs
            risk = counted * (found[:, 0] ** 2 - noise**2 + 2 * noise**2 * share)
            risks.append(self._stars.averaged(risk) / np.maximum(some, 1e-300))
            heights.append(found[:, 0].copy())
        risk = np.array(risks)
        # what the averages make of noise of one, as so many independent vertices would
        vertices = 1.0 / np.mean(self._stars.averaged(self._signs) ** 2)
        trust = np.exp(-vertices * (risk - risk.min(0)) / (4 * noise**2))
        return np.asarray((trust * np.array(heights)).sum(0) / trust.sum(0))


def _normals(points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(n, 3) unit normals of the vertices, each face by its area."""
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    here, there = points[corners], points[corners[following]]
    areas = np.add.reduceat(np.cross(here, there), offsets[:-1], axis=0)
    total = np.zeros_like(points)
    each = np.repeat(areas, np.diff(offsets), axis=0)
    for axis in range(3):
        total[:, axis] = np.bincount(corners, each[:, axis], len(points))
    return total / np.maximum(np.linalg.norm(total, axis=1), 1e-300)[:, None]
