# SPDX-License-Identifier: GPL-3.0-or-later
"""denoise(): removes the noise of a scan, with a strength chosen around each vertex.

Vertices move along their normals. With K h the difference of heights h from the mean of their neighbours, the
filters are 1 / (1 + t K²), smoothing splines [Reinsch 1967] in their simplest form, as polynomials of K. For
several amounts t the risk, the mean square error around a vertex, is estimated without bias [Stein 1981], and
the results are averaged with weights from it [Leung, Barron 2006]: strong where the shape is smooth, weak where
it has details, and weakest beside sharp edges.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.polynomial.chebyshev import chebinterpolate
from numpy.typing import ArrayLike

from .arrays import face_arrays, fixed_vertices, following, marked, vertex_array
from .converters import positive
from .errors import fairing_error

# Amounts besides zero, from half of the noise to smoothing over six edges, and the polynomials' degree.
# A sphere's error with this degree and with 28: 0.000887, 0.000877; bust and casting have equal errors.
_AMOUNTS, _DEGREE = 4.0 ** np.arange(6), 16
_DEGREE_OF_FIRST = 6  # for the smallest amount
# How often the risk is averaged over neighbours; 8 times covers 66 vertices of a triangle mesh. Errors
# with 5, 8 and 12 times: bust 0.0544, 0.0529, 0.0522; casting 0.0701, 0.0692, 0.0692.
_AVERAGES = 8
# A spike deviates by more standard deviations than chance causes in a million vertices, and by four
# times as much as its neighbours. Of 60 spikes of 1.5 mm in noise of 0.15 mm 58 are found, on both scans.
_SPIKE, _OVER_NEIGHBOURS = 5.0, 4.0
_OF_MEDIAN = 1.4826022185056018  # standard deviation over median of absolute values, if normal
_FARTHEST = 1e15  # largest height over the noise; sums of squares still fit into float32


class Denoised:
    """A mesh of n vertices after its noise has been removed.

    vertices: (n, 3) float64, mesh units, the new positions.
    moves: (n,) float64, mesh units, the distance by which each vertex has moved.
    noise: float, mesh units: root mean square distance of a vertex from the surface.
    rejected: (k,) int64, spikes, the worst first; their new places depend on their neighbours alone.
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
    """Remove the noise of a scan by a linear filter whose strength is chosen around each vertex.

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
    count = len(points)
    stays = fixed_vertices(fixed, count)
    if amount is not None:
        amount = positive("amount", amount)
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
        raise fairing_error(
            "INDEX_OUT_OF_RANGE", f"A face has a vertex that is not among the {len(points)}."
        )
    return denoised(points, corners, offsets, stays, amount)


def denoised(
    points: np.ndarray,
    corners: np.ndarray,
    offsets: np.ndarray,
    stays: np.ndarray,
    amount: float | None,
) -> Denoised:
    """denoise() for checked arrays."""
    none = np.empty(0, np.int64)
    if not len(corners):
        return Denoised(points, np.zeros_like(points), 0.0, none)
    stars = Stars(len(points), corners, offsets)
    here, held = stars.ordered(points), stars.ordered(stays) | (stars.counts == 0)
    middle = stars.mean(here)
    calm = stars.as_given(0.5 * (here + middle))
    normals = stars.ordered(_normals(calm - points.mean(axis=0), corners, offsets))
    off = np.einsum("ij,ij->i", here - middle, normals)
    heights = _Heights(stars, off, held | stars.corners(here))
    noise = heights.noise() if amount is None else float(amount)
    if not noise > 0:
        return Denoised(points, np.zeros_like(points), 0.0, none)
    found, spikes = heights.weighed(noise)
    moves = stars.as_given(found[:, None] * normals)
    return Denoised(points, moves, noise, stars.order[spikes])


class _Heights:
    """Filtered heights of vertices along their normals, from `off`, relative to neighbours."""

    def __init__(self, stars: Stars, off: np.ndarray, held: np.ndarray) -> None:
        self._stars, self._off, self._free = stars, off, ~held
        self._signs = np.random.default_rng(0).choice([-1.0, 1.0], len(off))  # [Hutchinson 1990]

    def noise(self) -> float:
        """Noise from the medians of second and third differences, over those of unit noise. The median
        ignores details and spikes, which concern few vertices; a smooth shape adds to both differences.
        """
        free = self._free
        if not free.any():
            return 0.0
        both, found = np.stack([self._stars.off_mean(self._signs), self._off], axis=1), []
        for _ in range(2):
            both = self._stars.off_mean(both)
            size = np.sqrt(np.mean(both[free, 0] ** 2))
            found.append(_OF_MEDIAN * np.median(np.abs(both[free, 1])) / size if size > 0 else 0.0)
        return float(min(found))

    def _filtered(
        self, off: np.ndarray, amounts: np.ndarray, degree: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """(n, amounts) heights, and the share of its own noise that each vertex keeps. Both are
        -t K / (1 + t K²) times `off`, as Chebyshev polynomials, since K is from 0 to 2. Single precision
        suffices for noise, and halves the time, most of which is spent on reading neighbours.
        """
        free = self._free[:, None].astype(np.float32)
        both = np.stack([off, self._stars.off_mean(self._signs)], axis=1)
        before = free * both.clip(-_FARTHEST, _FARTHEST).astype(np.float32)
        shares = np.array(
            [chebinterpolate(_spline, degree, (amount,)) for amount in amounts.tolist()], np.float32
        )
        now = -free * self._stars.mean(before)
        found = shares[:, 0, None, None] * before + shares[:, 1, None, None] * now
        for of_degree in shares.T[2:]:
            before, now = now, -2 * free * self._stars.mean(now) - before
            for one, share in zip(found, of_degree):
                one += share * now
        kept = 1 - found[:, :, 1] * self._signs.astype(np.float32)
        return -found[:, :, 0].T, np.ascontiguousarray(kept.T)

    def _spikes(self, heights: np.ndarray, kept: np.ndarray) -> np.ndarray:
        """Spikes, the worst first, from heights in units of the noise; none on borders."""
        chosen = self._free & ~self._stars.on_border
        share = float(kept[chosen].mean()) if chosen.any() else 0.0
        sizes = np.abs(heights) / max(1.0 - share, 1e-9)
        beside = _OVER_NEIGHBOURS * self._stars.mean(sizes)
        spikes = np.flatnonzero((sizes > np.maximum(_SPIKE, beside)) & chosen)
        return spikes[np.argsort(-sizes[spikes], kind="stable")]

    def weighed(self, noise: float) -> tuple[np.ndarray, np.ndarray]:
        """(n,) heights: the average over all amounts, weighted by the estimated risk around a vertex. And
        the spikes, which are moved to the mean of their neighbours before and do not count as data.
        """
        given = self._off / noise  # from here on in units of the noise
        heights, kept = self._filtered(given, _AMOUNTS[:1], _DEGREE_OF_FIRST)
        spikes = self._spikes(heights[:, 0], kept[:, 0])
        off, placed = given, np.zeros(len(heights))
        for _ in range(2):  # some spikes are side by side
            placed[spikes] -= off[spikes]
            off = given + self._stars.off_mean(placed)
        heights, kept = self._filtered(off, _AMOUNTS, _DEGREE)
        counted = self._free.astype(np.float32)
        counted[spikes] = 0.0
        risk = counted[:, None] * (heights**2 - 1 + 2 * kept)
        signs = self._signs.astype(np.float32)
        risk = self._averaged(np.column_stack([risk, counted, signs]))
        # independent vertices in an average, from the averages of random signs
        vertices = 1.0 / np.mean(risk[:, -1] ** 2, dtype=float)
        risk = risk[:, :-2] / np.maximum(risk[:, -2:-1], np.float32(1e-30))
        # the amount zero leaves all the noise
        least = np.minimum(risk.min(axis=1, keepdims=True), 1)
        trust = np.exp(-vertices * (risk - least) / 4)
        of_none = np.exp(-vertices * (1 - least[:, 0]) / 4)
        taken = placed + (trust * heights).sum(1) / (trust.sum(1) + of_none)
        return noise * taken, spikes

    def _averaged(self, values: np.ndarray) -> np.ndarray:
        """Means over neighbours. The last one includes the vertex itself, since on quads the neighbours
        of neighbours are only every other vertex."""
        for _ in range(_AVERAGES):
            values = self._stars.mean(values)
        return 0.5 * (values + self._stars.mean(values))


def _spline(x: np.ndarray, amount: float) -> np.ndarray:
    """The share that a smoothing spline removes, divided by K = 1 + x."""
    return amount * (1 + x) / (1 + amount * (1 + x) ** 2)


def _normals(points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(n, 3) unit normals of the vertices, weighted by the faces' areas."""
    here, there = points[corners], points[corners[following(offsets)]]
    areas = np.add.reduceat(np.cross(here, there), offsets[:-1], axis=0)
    total = np.zeros_like(points)
    each = np.repeat(areas, np.diff(offsets), axis=0)
    for axis in range(3):
        total[:, axis] = np.bincount(corners, each[:, axis], len(points))
    return total / np.maximum(np.linalg.norm(total, axis=1), 1e-300)[:, None]


_CORNER = 2 * np.sin(np.pi / 8)  # distance of two unit vectors that turn by 45°


class Stars:
    """The neighbours of each vertex; at a border only those along it.

    Arrays are sorted by valence, largest first, so that the k-th neighbours of all vertices that have k
    form one array. This is eleven times as fast as sums over a list.
    """

    def __init__(self, count: int, corners: np.ndarray, offsets: np.ndarray) -> None:
        sides = np.sort(np.stack([corners, corners[following(offsets)]], axis=1), axis=1)
        keys = np.sort(sides[:, 0] * np.int64(count) + sides[:, 1])
        first = np.flatnonzero(np.diff(keys, prepend=-1))
        uses = np.diff(first, append=len(keys))
        edges = np.stack([keys[first] // count, keys[first] % count], axis=1)
        border = uses == 1
        on_border = marked(edges[border], count)
        start, end = np.concatenate([edges, edges[:, ::-1]]).T
        along = ~on_border[start] | np.tile(border, 2)
        start, end = start[along], end[along]
        counts = np.bincount(start, minlength=count)
        self.order = np.argsort(-counts, kind="stable")
        self._rank = np.empty(count, np.int64)
        self._rank[self.order] = np.arange(count)
        self.counts, self.on_border = counts[self.order], on_border[self.order]
        self._shares = 1.0 / np.maximum(self.counts, 1)
        rows = self._rank[start]
        by_row = np.argsort(rows, kind="stable")
        ends = self._rank[end[by_row]]
        begins = np.cumsum(self.counts) - self.counts
        having = np.searchsorted(-self.counts, -np.arange(self.counts.max(initial=0)), "left")
        # the k-th neighbours of the first vertices, those with at least k neighbours
        self._ranks = [ends[begins[:some] + k] for k, some in enumerate(having.tolist())]

    def ordered(self, values: np.ndarray) -> np.ndarray:
        return np.ascontiguousarray(values[self.order])

    def as_given(self, values: np.ndarray) -> np.ndarray:
        return values[self._rank]

    def mean(self, values: np.ndarray) -> np.ndarray:
        """Means of `values` (n,) or (n, k) over the neighbours, in their precision; a vertex without
        neighbours keeps its own value."""
        found = values.copy()
        if self._ranks:
            found[: len(self._ranks[0])] = values.take(self._ranks[0], axis=0)
        for ranks in self._ranks[1:]:
            found[: len(ranks)] += values.take(ranks, axis=0)
        shares = self._shares.astype(values.dtype, copy=False)
        found *= shares.reshape(-1, *[1] * (values.ndim - 1))
        return found

    def off_mean(self, values: np.ndarray) -> np.ndarray:
        """Differences of `values` from the means over the neighbours."""
        return values - self.mean(values)

    def corners(self, points: np.ndarray) -> np.ndarray:
        """(n,) bool: vertices where borders meet, or where a border turns by more than 45 degrees."""
        found = self.on_border & (self.counts != 2)
        two = np.flatnonzero(self.on_border & (self.counts == 2))
        if len(two):
            ends = [points[ranks[two]] - points[two] for ranks in self._ranks[:2]]
            lengths = sum(np.linalg.norm(end, axis=1) for end in ends)
            # the turn of two sides of equal length
            found[two] = np.linalg.norm(ends[0] + ends[1], axis=1) > _CORNER * lengths / 2
        return found
