# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches evaluated by SciPy, from nets and knots alone."""

import numpy as np
from discrete_fairing import spline_knots
from scipy.interpolate import BSpline


def basis(spans: int, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values and derivatives (len(at), spans + 3) of the basis functions."""
    spline = BSpline(spline_knots(spans), np.eye(spans + 3), 3)
    return spline(at), spline.derivative()(at)


def evaluate(patches, p: int, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and normals with their lengths, (len(u), len(v), 3), of patch p."""
    (au, du), (av, dv) = (basis(s, at) for s, at in zip(patches.patch_spans[p], (u, v)))
    net = patches.net(p)
    at, along_u, along_v = (
        np.einsum("ai,bj,ijk->abk", a, b, net) for a, b in ((au, av), (du, av), (au, dv))
    )
    return at, np.cross(along_u, along_v)


def gauss(spans: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [0, 1] that are exact for products of the patches' derivatives."""
    x, w = np.polynomial.legendre.leggauss(6)
    nodes = (np.arange(spans)[:, None] + (1 + x) / 2) / spans
    return nodes.ravel(), np.tile(w / 2 / spans, spans)


def volume(patches) -> float:
    """Inside all patches, by the divergence theorem."""
    total = 0.0
    for p, (spans_u, spans_v) in enumerate(patches.patch_spans.tolist()):
        (u, wu), (v, wv) = gauss(spans_u), gauss(spans_v)
        at, normal = evaluate(patches, p, u, v)
        total += np.einsum("a,b,abk,abk->", wu, wv, at, normal)
    return total / 3


def radii(patches, samples: int = 33) -> np.ndarray:
    """Distances of points of all patches from the origin."""
    t = np.linspace(0, 1, samples)
    found = [evaluate(patches, p, t, t)[0] for p in range(len(patches))]
    return np.linalg.norm(found, axis=3)


def lattice_volume(result, levels: int) -> float:
    """The volume inside, extrapolated from all points, every second and fourth: powers of 4."""
    fine, middle, coarse = (
        sum(_grid_volume(result.vertices, grid, step) for grid in _grids(result, levels))
        for step in (1, 2, 4)
    )
    better, good = fine + (fine - middle) / 3, middle + (middle - coarse) / 3
    return better + (better - good) / 15


def _grids(result, levels: int):
    """(corners, (F, n + 1, n + 1) point ids) of triangles and quads; -1 beyond a long side."""
    n = 2**levels
    for corners, faces in zip((3, 4), result.faces):
        cells = faces.reshape(-1, n * n, corners)
        grid = np.full((len(cells), n + 1, n + 1), -1)
        j, i = np.divmod(np.arange(n * n), n)
        if corners == 3:
            kept = i + j < n
            j, i = j[kept], i[kept]
            cells = cells[:, n * n - (n - j) ** 2 + 2 * i]
        for k, (right, up) in enumerate(_CORNERS[corners]):
            grid[:, j + up, i + right] = cells[:, :, k]
        yield corners, grid


_CORNERS = {3: ((0, 0), (1, 0), (0, 1)), 4: ((0, 0), (1, 0), (1, 1), (0, 1))}


def _grid_volume(points: np.ndarray, found, step: int) -> float:
    """Of the cone from the origin over a grid's cells, `step` points wide."""
    corners, grid = found
    grid = grid[:, ::step, ::step]
    a, b, c, d = (grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1])
    if corners == 3:
        return _cones(points, a, b, d) + _cones(points, b, c, d)
    # the mean of both ways to cut a quad is its bilinear surface
    ways = ((a, b, c), (a, c, d), (a, b, d), (b, c, d))
    return sum(_cones(points, *way) for way in ways) / 2


def _cones(points: np.ndarray, *corners: np.ndarray) -> float:
    there = np.all([corner >= 0 for corner in corners], axis=0)
    a, b, c = (points[corner[there]] for corner in corners)
    return float(np.einsum("ij,ij->", np.cross(a, b), c) / 6)
