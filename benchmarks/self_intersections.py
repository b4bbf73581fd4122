# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts triangles of a mesh that cross others. Plain NumPy, without the core."""

import numpy as np

CELL = 2.0  # of the grid, in medians of the triangles' extents
MOST_CELLS = 64  # that a triangle is entered in, along an axis
CROSSING = 1e-9  # barycentric: farther inside than rounding
AT_ONCE = 2_000_000  # pairs


def crossing_triangles(points: np.ndarray, triangles: np.ndarray) -> int:
    """The number of crossing pairs, without pairs that share a vertex or only touch."""
    found = [np.zeros(0, np.int64)]
    for a, b in candidates(points[triangles]):
        shared = (triangles[a][:, :, None] == triangles[b][:, None, :]).any((1, 2))
        a, b = a[~shared], b[~shared]
        meets = np.zeros(len(a), bool)
        for one, other in ((a, b), (b, a)):
            for k in range(3):
                ends = points[triangles[one][:, [k, (k + 1) % 3]]]
                meets |= pierces(ends[:, 0], ends[:, 1], points[triangles[other]])
        found += [a[meets], b[meets]]
    return len(np.unique(np.concatenate(found)))


def candidates(corner: np.ndarray):
    """Pairs whose boxes overlap, some thousands at a time; a pair may come twice."""
    low, high = corner.min(1), corner.max(1)
    extent = (high - low).max(1)
    size = max(CELL * float(np.median(extent)), float(extent.max()) / MOST_CELLS)
    if not size > 0:
        return
    first = np.floor((low - low.min(0)) / size).astype(np.int64)
    count = np.floor((high - low.min(0)) / size).astype(np.int64) - first + 1
    cells = count.prod(1)
    owner = np.repeat(np.arange(len(corner)), cells)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(cells) - cells, cells)
    at = [place % count[owner, 0], place // count[owner, 0] % count[owner, 1]]
    at.append(place // (count[owner, 0] * count[owner, 1]))
    cell = sum((first[owner, k] + at[k]) << (21 * k) for k in range(3))
    order = np.argsort(cell, kind="stable")
    owner, cell = owner[order], cell[order]
    end = np.searchsorted(cell, cell, side="right")
    later = end - np.arange(len(owner)) - 1  # in the same cell
    begin = 0
    while begin < len(owner):
        total = np.cumsum(later[begin:])
        stop = begin + max(1, int(np.searchsorted(total, AT_ONCE)))
        own = np.repeat(np.arange(begin, stop), later[begin:stop])
        steps = np.arange(len(own)) - np.repeat(
            total[: stop - begin] - later[begin:stop], later[begin:stop]
        )
        a, b = owner[own], owner[own + 1 + steps]
        overlap = ((low[a] <= high[b]) & (low[b] <= high[a])).all(1)
        yield a[overlap], b[overlap]
        begin = stop


def pierces(start: np.ndarray, end: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """Which segments pass through the inside of their triangles [Möller and Trumbore 1997]."""
    way = end - start
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    across = np.cross(way, v)
    determinant = (u * across).sum(1)
    size = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1) * np.linalg.norm(way, axis=1)
    flat = np.abs(determinant) <= CROSSING * size
    inverse = 1 / np.where(flat, 1.0, determinant)
    offset = start - corner[:, 0]
    turned = np.cross(offset, u)
    first = inverse * (offset * across).sum(1)
    second = inverse * (way * turned).sum(1)
    along = inverse * (v * turned).sum(1)
    inside = np.minimum.reduce([first, second, 1 - first - second, along, 1 - along]) > CROSSING
    return inside & ~flat
