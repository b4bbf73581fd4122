# SPDX-License-Identifier: GPL-3.0-or-later
"""Modified butterfly [Zorin, Schröder, Sweldens 1996] on closed triangle meshes: a rival to compare
energies with."""

import numpy as np


def refine(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Refines by one level: old vertices stay, and every edge gets a new vertex."""
    rings = ordered_rings(len(points), triangles)
    number, new = {}, []
    for a, b in sorted(
        {tuple(sorted(e)) for t in triangles.tolist() for e in zip(t, [*t[1:], t[0]])}
    ):
        number[a, b] = len(points) + len(new)
        new.append(edge_point(points, rings, a, b))
    side = [number[tuple(sorted(e))] for t in triangles.tolist() for e in zip(t, [*t[1:], t[0]])]
    ab, bc, ca = np.array(side).reshape(-1, 3).T
    a, b, c = triangles.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([points, new]), np.concatenate([np.stack(p, -1) for p in parts])


def ordered_rings(count: int, triangles: np.ndarray) -> list[list[int]]:
    """The neighbours of every vertex, counter-clockwise."""
    onward = [{} for _ in range(count)]
    for t in triangles.tolist():
        for k in range(3):
            onward[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3]
    rings = []
    for after in onward:
        ring = [next(iter(after))]
        while len(ring) < len(after):
            ring.append(after[ring[-1]])
        rings.append(ring)
    return rings


def edge_point(points, rings, a, b):
    regular = [v for v in (a, b) if len(rings[v]) == 6]
    if len(regular) == 2:
        return sum(half_stencil(points, rings, *e) for e in ((a, b), (b, a)))
    ends = [(a, b), (b, a)] if not regular else [(b, a) if regular == [a] else (a, b)]
    return sum(irregular(points, rings, *e) for e in ends) / len(ends)


def half_stencil(points, rings, v, w):
    """The contribution of v's side of a regular edge: the ten-point stencil, halved where both ends share a
    point.
    """
    ring = rings[v]
    k = ring.index(w)
    left, right = points[ring[(k + 1) % 6]], points[ring[k - 1]]
    outer = points[ring[(k + 2) % 6]] + points[ring[k - 2]]
    return points[v] / 2 + (left + right) / 16 - outer / 16


def irregular(points, rings, v, w):
    ring = rings[v]
    n, k = len(ring), ring.index(w)
    j = np.arange(n)
    if n == 3:
        weights = np.array([5, -1, -1]) / 12
    elif n == 4:
        weights = np.array([3, 0, -1, 0]) / 8
    else:
        weights = (0.25 + np.cos(2 * np.pi * j / n) + 0.5 * np.cos(4 * np.pi * j / n)) / n
    return (1 - weights.sum()) * points[v] + weights @ points[[ring[(k + i) % n] for i in j]]
