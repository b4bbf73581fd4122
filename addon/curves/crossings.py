# SPDX-License-Identifier: GPL-3.0-or-later
"""Points where two curves meet or nearly meet: local minima of their distance."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .cubics import Curve, points_at, points_on, tangents_on

STEPS = 16  # chords of a piece for the search of minima
_ROUNDS = 12  # Gauss–Newton iterations; crossings at right angles take four


@dataclass(frozen=True)
class Meeting:
    """A local minimum of distance: the curve `a` at its parameter `ta`, the curve `b` at `tb`."""

    a: int
    ta: float
    b: int
    tb: float
    distance: float
    place: np.ndarray  # (3,) the midpoint


def meetings(curves: Sequence[Curve], reach: float) -> list[Meeting]:
    """All meetings with distances up to `reach`, by pairs of curves and by parameters."""
    chords = [curve_chords(curve)[1] for curve in curves]
    found: list[tuple[int, float, int, float]] = []
    for a in range(len(curves)):
        for b in range(a + 1, len(curves)):
            if _apart(chords[a], chords[b], reach):
                continue
            for i, j in _minima(chords[a], chords[b], reach, curves[a].closed, curves[b].closed):
                found.append((a, (i + 0.5) / STEPS, b, (j + 0.5) / STEPS))
    if not found:
        return []
    of_a, ta, of_b, tb = (np.array(column) for column in zip(*found, strict=True))
    ta, tb, pa, pb = _refined(curves, of_a, ta, of_b, tb)
    gaps = np.linalg.norm(pa - pb, axis=1)
    refined = [
        Meeting(int(a), float(s), int(b), float(t), float(gap), (p + q) / 2)
        for a, s, b, t, gap, p, q in zip(of_a, ta, of_b, tb, gaps, pa, pb, strict=True)
        if gap <= reach
    ]
    return _once(curves, refined)


def curve_chords(curve: Curve) -> tuple[np.ndarray, np.ndarray]:
    """(k,) parameters of the ends of a curve's chords, and (k, 3) these ends."""
    t = np.arange(STEPS * len(curve.pieces) + 1) / STEPS
    return t, points_at(curve.pieces, t)


def _apart(p: np.ndarray, q: np.ndarray, reach: float) -> bool:
    return bool(
        (p.min(axis=0) > q.max(axis=0) + reach).any()
        or (q.min(axis=0) > p.max(axis=0) + reach).any()
    )


def _minima(
    p: np.ndarray, q: np.ndarray, reach: float, closed_p: bool, closed_q: bool
) -> list[tuple[int, int]]:
    """Pairs of chords whose distance is at most that of all neighbouring pairs."""
    middles = [(x[:-1] + x[1:]) / 2 for x in (p, q)]
    halves = [np.linalg.norm(np.diff(x, axis=0), axis=1) / 2 for x in (p, q)]
    most = (reach + halves[0][:, None] + halves[1][None]) ** 2
    start = middles[0][0]  # expanded squares of differences lose no digits near the origin
    a, b = middles[0] - start, middles[1] - start
    far = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1)[None] - 2.0 * (a @ b.T)
    rows, columns = np.nonzero(far <= most + 1e-12 * np.abs(far).max())
    gaps = np.full(far.shape, np.inf)
    gaps[rows, columns] = _between(p[rows], p[rows + 1], q[columns], q[columns + 1])
    least = gaps.copy()
    for axis, closed in ((0, closed_p), (1, closed_q)):
        ahead, behind = np.roll(least, -1, axis), np.roll(least, 1, axis)
        if not closed:
            edge = [slice(None)] * 2
            edge[axis] = slice(-1, None)
            ahead[tuple(edge)] = np.inf
            edge[axis] = slice(0, 1)
            behind[tuple(edge)] = np.inf
        least = np.minimum(least, np.minimum(ahead, behind))
    near = (gaps <= least * (1 + 1e-9) + 1e-300) & (gaps <= 1.5 * reach)
    return [(int(i), int(j)) for i, j in zip(*np.nonzero(near), strict=True)]


def _between(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """(k,): distances of the segments pq and rs."""
    d, e, w = q - p, s - r, p - r
    a, b, c = (np.einsum("ij,ij->i", x, y) for x, y in ((d, d), (d, e), (e, e)))
    f, g = np.einsum("ij,ij->i", d, w), np.einsum("ij,ij->i", e, w)
    det = a * c - b * b
    u = np.clip(
        np.where(det > 1e-12 * a * c, (b * g - c * f) / np.where(det == 0, 1, det), 0), 0, 1
    )
    v = np.clip((b * u + g) / np.maximum(c, 1e-300), 0, 1)
    u = np.clip((b * v - f) / np.maximum(a, 1e-300), 0, 1)
    return np.linalg.norm(w + u[:, None] * d - v[:, None] * e, axis=1)


def _refined(
    curves: Sequence[Curve], a: np.ndarray, ta: np.ndarray, b: np.ndarray, tb: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Parameters and points of least distance, for all pairs: Gauss–Newton, clamped to the ends."""
    starts = np.concatenate([[0], np.cumsum([len(c.pieces) for c in curves])]).astype(float)
    pieces = np.concatenate([curve.pieces for curve in curves])
    closed = np.array([curve.closed for curve in curves])
    counts = np.diff(starts)

    def clamped(t: np.ndarray, of: np.ndarray) -> np.ndarray:
        return np.where(closed[of], t % counts[of], np.clip(t, 0, counts[of]))

    def on(t: np.ndarray, of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        part = np.minimum(np.floor(t), counts[of] - 1)  # the end belongs to the last piece
        return pieces[(starts[of] + part).astype(int)], t - part

    for _ in range(_ROUNDS):
        r = points_on(*on(ta, a)) - points_on(*on(tb, b))
        d, e = tangents_on(*on(ta, a)), tangents_on(*on(tb, b))
        dd, de, ee = (np.einsum("ij,ij->i", x, y) for x, y in ((d, d), (d, e), (e, e)))
        dr, er = np.einsum("ij,ij->i", d, r), np.einsum("ij,ij->i", e, r)
        damp = 1e-9 * (dd + ee) + 1e-300
        det = (dd + damp) * (ee + damp) - de * de
        ta = clamped(ta + np.clip((de * er - (ee + damp) * dr) / det, -0.5, 0.5), a)
        # solved again, since the other parameter may have been clamped
        r = points_on(*on(ta, a)) - points_on(*on(tb, b))
        tb = clamped(tb + np.clip(np.einsum("ij,ij->i", e, r) / (ee + damp), -0.5, 0.5), b)
    return ta, tb, points_on(*on(ta, a)), points_on(*on(tb, b))


def _once(curves: Sequence[Curve], found: list[Meeting]) -> list[Meeting]:
    """The meetings without duplicates from neighbouring chords."""
    kept: list[Meeting] = []
    for one in sorted(found, key=lambda m: (m.a, m.b, m.distance)):
        others = (m for m in kept if (m.a, m.b) == (one.a, one.b))
        if all(
            _span(curves[one.a], m.ta, one.ta) > 0.5 / STEPS
            or _span(curves[one.b], m.tb, one.tb) > 0.5 / STEPS
            for m in others
        ):
            kept.append(one)
    return sorted(kept, key=lambda m: (m.a, m.b, m.ta, m.tb))


def _span(curve: Curve, t: float, u: float) -> float:
    """The difference of two parameters, the shorter way around."""
    gap = abs(t - u)
    return min(gap, curve.end - gap) if curve.closed else gap
