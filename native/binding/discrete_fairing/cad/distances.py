# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of points from spline patches, each from the patches of the face below the point."""

from __future__ import annotations

import numpy as np

from .patches import SplinePatches

_SAMPLES = 8  # least samples a side of a patch (two a span), from which Newton's steps start
_STEPS = 8
_AT_ONCE = 1 << 15  # points: 16 control points each


def distances_from(patches: SplinePatches, points: np.ndarray, polygons: np.ndarray) -> np.ndarray:
    """(S,) float64 distances of `points` (S, 3), positive outside, along the patch's normal at the nearest
    point of the patches that cover the input faces `polygons` (S,); NaN where a polygon is -1.
    """
    found = np.full(len(points), np.nan)
    patch, places = _begin(patches, points, polygons)
    for first in range(0, len(points), _AT_ONCE):
        part = np.arange(first, min(first + _AT_ONCE, len(points)))
        part = part[patch[part] >= 0]
        found[part] = _along_normals(patches, points[part], patch[part], places[part])
    return found


def _begin(
    patches: SplinePatches, points: np.ndarray, polygons: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The patch of each point, -1 for none, and the parameters of its nearest sample."""
    patch, places = np.full(len(points), -1), np.zeros((len(points), 2))
    order = np.argsort(polygons, kind="stable")
    samples, grids = zip(*(_samples(patches, p) for p in range(len(patches))), strict=True)
    for polygon, own in _patches_of(patches).items():
        here = _with(order, polygons, polygon)
        if not len(here):
            continue
        middle = points[here].mean(axis=0)
        near = np.concatenate([samples[p] for p in own]) - middle
        ids = np.repeat(own, [len(samples[p]) for p in own])
        grid = np.concatenate([grids[p] for p in own])
        square = (near**2).sum(axis=1)
        # no nearest sample is farther from the middle than this, by the triangle inequality
        away, across = np.sqrt(square), np.linalg.norm(points[here] - middle, axis=1).max()
        # lengths, since rounding of squares may leave none
        kept = away <= 2.0 * across + away.min()
        near, ids, grid, square = near[kept], ids[kept], grid[kept], square[kept]
        for rows in np.array_split(here, len(here) * len(near) // 2**22 + 1):
            nearest = (square - 2.0 * (points[rows] - middle) @ near.T).argmin(axis=1)
            patch[rows], places[rows] = ids[nearest], grid[nearest]
    return patch, places


def _samples(patches: SplinePatches, p: int) -> tuple[np.ndarray, np.ndarray]:
    """(k, 3) sample points of patch p, and their parameters, (k, 2) in [0, 1]²."""
    sides = [
        np.linspace(0.0, 1.0, max(_SAMPLES, 2 * n) + 1) for n in patches.patch_spans[p].tolist()
    ]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 2)
    return evaluate(patches, np.full(len(grid), p), grid)[0], grid


def _patches_of(patches: SplinePatches) -> dict[int, list[int]]:
    """The patches that cover each input face."""
    found: dict[int, list[int]] = {}
    for p in range(len(patches)):
        for polygon in patches.polygons(p).tolist():
            found.setdefault(polygon, []).append(p)
    return found


def _with(order: np.ndarray, values: np.ndarray, value: int) -> np.ndarray:
    """Positions at which `values` equal `value`; `order` sorts `values`."""
    begin, end = np.searchsorted(values, [value, value + 1], sorter=order)
    return order[begin:end]


def _along_normals(
    patches: SplinePatches, points: np.ndarray, patch: np.ndarray, places: np.ndarray
) -> np.ndarray:
    best, step = places, np.zeros_like(places)
    nearest, share = np.full(len(points), np.inf), np.ones(len(points))
    for _ in range(_STEPS):
        at, along, across = evaluate(patches, patch, places)
        square = ((points - at) ** 2).sum(1)
        nearer = square < nearest
        # a step that leads away is shortened: at corners patches may hardly grow along a side
        share = np.where(nearer, 1.0, share / 4)
        best, nearest = np.where(nearer[:, None], places, best), np.minimum(square, nearest)
        step = np.where(nearer[:, None], _step(points - at, along, across, places), step)
        places = np.clip(best + share[:, None] * step, 0.0, 1.0)
    places = best
    at, along, across = evaluate(patches, patch, places)
    normal = np.cross(along, across)
    length = np.linalg.norm(normal, axis=1)
    return ((points - at) * normal).sum(1) / np.where(length > 0.0, length, np.inf)


def _step(
    rest: np.ndarray, along: np.ndarray, across: np.ndarray, places: np.ndarray
) -> np.ndarray:
    """(k, 2): Gauss-Newton steps; along a side where one would leave the patch."""
    a, b, c = ((x * y).sum(1) for x, y in ((along, along), (along, across), (across, across)))
    p, q = ((rest * x).sum(1) for x in (along, across))
    a, c = (np.where(x > 0.0, x, 1.0) for x in (a, c))  # b, p or q are 0 there
    determinant = a * c - b * b
    determinant[~(determinant > 0.0)] = np.inf
    du = np.clip((c * p - b * q) / determinant, -places[:, 0], 1.0 - places[:, 0])
    dv = np.clip((q - b * du) / c, -places[:, 1], 1.0 - places[:, 1])
    return np.stack([(p - b * dv) / a, dv], 1)


def evaluate(
    patches: SplinePatches, patch: np.ndarray, places: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(k, 3) points of patches `patch` (k,) at `places` (k, 2) in [0, 1]², and both derivatives."""
    spans = patches.patch_spans[patch].astype(np.int64)
    (row, u, du), (column, v, dv) = (_basis(places[:, k], spans[:, k]) for k in (0, 1))
    rows, columns = (first[:, None] + np.arange(4) for first in (row, column))
    ids = patches.patch_offsets[patch][:, None, None] + (
        rows[:, :, None] * (spans[:, 1] + 3)[:, None, None] + columns[:, None, :]
    )
    net = patches.patch_points[ids]
    across, across_slope = (np.einsum("kabx,kb->kax", net, w) for w in (v, dv))
    return (
        np.einsum("kax,ka->kx", across, u),
        np.einsum("kax,ka->kx", across, du),
        np.einsum("kax,ka->kx", across_slope, u),
    )


def _basis(x: np.ndarray, spans: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The index of the first of four nonzero cubics at x (k,), their values and slopes (k, 4), on the
    knots of spline_knots() [Piegl and Tiller 1997, A2.2].
    """
    n = spans.astype(np.float64)
    first = np.minimum((x * n).astype(np.int64), spans - 1)

    def knot(i: int) -> np.ndarray:
        return np.clip((first + i - 3) / n, 0.0, 1.0)

    values = [np.ones_like(x)]
    for degree in (1, 2, 3):
        lower, values = values, [np.zeros_like(x) for _ in range(degree + 1)]
        slopes = [np.zeros_like(x) for _ in range(degree + 1)]
        for r in range(degree):
            low, high = knot(4 - degree + r), knot(4 + r)
            share = lower[r] / (high - low)
            values[r] += (high - x) * share
            values[r + 1] += (x - low) * share
            slopes[r] -= degree * share
            slopes[r + 1] += degree * share
    return first, np.stack(values, 1), np.stack(slopes, 1)
