# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves as cubic pieces, from Bézier or NURBS splines or from points."""

from dataclasses import dataclass

import numpy as np

# half: the cosine of a turn of 60°, above which a polygon has a corner, like borders (core.py)
_COSINE_OF_CORNER = 0.5
# pieces for one span of a NURBS curve: a rational quarter of a circle is off by 1.4e-5 of its radius
_PIECES_OF_SPAN = 8
# points that extend a closed curve: the effect of a spline's end falls to 0.27 with each
_OVERLAP = 12


@dataclass(frozen=True)
class Curve:
    """`pieces` (s, 4, 3) float64: Bézier points in the world; parameters run from 0 to s."""

    name: str
    pieces: np.ndarray
    closed: bool = False
    sharp: bool = False  # whether the surface has a crease there

    @property
    def end(self) -> float:
        return float(len(self.pieces))


def points_at(pieces: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(k, 3): points at the parameters `t` (k,)."""
    part, u = _split(pieces, t)
    return points_on(pieces[part], u)


def points_on(pieces: np.ndarray, u: np.ndarray) -> np.ndarray:
    """(k, 3): a point on each of the `pieces` (k, 4, 3), at `u` (k,), from 0 to 1."""
    v = 1.0 - u
    weights = np.stack([v**3, 3 * u * v**2, 3 * u**2 * v, u**3], axis=-1)
    return np.einsum("ki,kij->kj", weights, pieces)


def tangents_on(pieces: np.ndarray, u: np.ndarray) -> np.ndarray:
    """(k, 3): derivatives at these points; zero if handles have no length."""
    v = 1.0 - u
    steps = 3.0 * np.diff(pieces, axis=1)
    return np.einsum("ki,kij->kj", np.stack([v**2, 2 * u * v, u**2], axis=-1), steps)


def _split(pieces: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    part = np.clip(np.floor(t).astype(int), 0, len(pieces) - 1)
    return part, t - part


def from_bezier(
    points: np.ndarray, left: np.ndarray, right: np.ndarray, closed: bool
) -> np.ndarray:
    """Pieces of a Bézier spline, from its points and their handles, (k, 3) each."""
    after = np.roll(np.arange(len(points)), -1)
    pieces = np.stack([points, right, left[after], points[after]], axis=1)
    return pieces if closed else pieces[:-1]


def through(points: np.ndarray, closed: bool) -> np.ndarray:
    """Pieces of the chord-length cubic spline through `points` (k, 3); over 60° are corners."""
    points = np.asarray(points, float)
    ahead = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    kept = ahead > 0
    if not closed:
        kept[-1] = True
    points = points[kept]
    count = len(points)
    if count < 2:
        return np.zeros((0, 4, 3))
    corners = _corners(points, closed)
    if not closed:
        stops = [0, *corners, count - 1]
        return np.concatenate(
            [_spline(points[a : b + 1]) for a, b in zip(stops, stops[1:], strict=False)]
        )
    if not corners:
        lap = [(i % count) for i in range(-_OVERLAP, count + _OVERLAP + 1)]
        return _spline(points[lap])[_OVERLAP : _OVERLAP + count]
    rolled = np.roll(points, -corners[0], axis=0)
    stops = [*(c - corners[0] for c in corners), count]
    rolled = np.concatenate([rolled, rolled[:1]])
    return np.concatenate(
        [_spline(rolled[a : b + 1]) for a, b in zip(stops, stops[1:], strict=False)]
    )


def _corners(points: np.ndarray, closed: bool) -> list[int]:
    steps = np.roll(points, -1, axis=0) - points
    steps /= np.maximum(np.linalg.norm(steps, axis=1), 1e-300)[:, None]
    turns = np.einsum("ij,ij->i", np.roll(steps, 1, axis=0), steps) < _COSINE_OF_CORNER
    if not closed:
        turns[[0, -1]] = False
    return [int(i) for i in np.flatnonzero(turns)]


def _spline(points: np.ndarray) -> np.ndarray:
    """Second derivatives by Thomas's algorithm; at the ends they equal those of the neighbours."""
    h = np.linalg.norm(np.diff(points, axis=0), axis=1)
    slopes = np.diff(points, axis=0) / h[:, None]
    count = len(points)
    bends = np.zeros_like(points)
    if count > 2:
        inner = 2.0 * (h[:-1] + h[1:])
        inner[0] += h[0]
        inner[-1] += h[-1]
        right = 6.0 * np.diff(slopes, axis=0)
        for i in range(1, count - 2):
            share = h[i] / inner[i - 1]
            inner[i] -= share * h[i]
            right[i] -= share * right[i - 1]
        bends[count - 2] = right[-1] / inner[-1]
        for i in range(count - 4, -1, -1):
            bends[i + 1] = (right[i] - h[i + 1] * bends[i + 2]) / inner[i]
        bends[0], bends[-1] = bends[1], bends[-2]
    starts = slopes - h[:, None] * (2 * bends[:-1] + bends[1:]) / 6
    ends = slopes + h[:, None] * (bends[:-1] + 2 * bends[1:]) / 6
    return _hermite(points[:-1], points[1:], starts * h[:, None], ends * h[:, None])


def _hermite(a: np.ndarray, b: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    return np.stack([a, a + start / 3, b - end / 3, b], axis=1)


def from_nurbs(
    points: np.ndarray, order: int, closed: bool, clamped: bool, bezier: bool
) -> np.ndarray:
    """Pieces of a NURBS spline: `points` (k, 4) with weights; Cyclic, Endpoint, Bézier."""
    count = len(points)
    order = min(order, count)
    knots = _knots(count, order, closed, clamped, bezier)
    degree = order - 1
    if closed:
        points = np.concatenate([points, points[:degree]])
    rows = np.concatenate([points[:, :3] * points[:, 3:], points[:, 3:]], axis=1)
    found = []
    for k in range(degree, len(points)):
        if knots[k + 1] > knots[k]:
            u = np.linspace(knots[k], knots[k + 1], _PIECES_OF_SPAN + 1)
            place, way = _de_boor(rows, knots, degree, k, u)
            way *= u[1] - u[0]
            found.append(_hermite(place[:-1], place[1:], way[:-1], way[1:]))
    return np.concatenate(found) if found else np.zeros((0, 4, 3))


def _knots(count: int, order: int, closed: bool, clamped: bool, bezier: bool) -> np.ndarray:
    """Blender's knots [curve_nurbs.cc, calculate_knots]."""
    repeat = order - 1 if bezier else 1
    first = (order - (1 if closed else 0)) if clamped else (min(2, repeat) if bezier else 1)
    tail = 2 * order - 1 if closed else (order if clamped else 0)
    size = count + (2 * order - 1 if closed else order)
    knots = np.zeros(size)
    left, now, offset = first, 0.0, 1 if clamped and closed else 0
    if offset:
        now += 1.0
    for i in range(offset, size - tail):
        knots[i] = now
        left -= 1
        if left == 0:
            now, left = now + 1.0, repeat
    for i in range(tail):
        knots[size - tail + i] = now + (knots[i] - knots[0])
    return knots


def _de_boor(
    rows: np.ndarray, knots: np.ndarray, degree: int, k: int, u: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(points, derivatives) at the parameters `u` of the span k."""
    table = [np.repeat(rows[None, k - degree + j], len(u), axis=0) for j in range(degree + 1)]
    speed = np.zeros((len(u), 4))
    for r in range(1, degree + 1):
        if r == degree:
            speed = degree * (table[degree] - table[degree - 1]) / (knots[k + 1] - knots[k])
        for j in range(degree, r - 1, -1):
            low, high = knots[j + k - degree], knots[j + 1 + k - r]
            share = ((u - low) / (high - low))[:, None]
            table[j] = (1 - share) * table[j - 1] + share * table[j]
    weight = table[degree][:, 3:]
    place = table[degree][:, :3] / weight
    return place, (speed[:, :3] - place * speed[:, 3:]) / weight
