# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes, where curves meet or turn, and the arcs between them; loose parts are removed and reported."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .. import core
from .crossings import STEPS, Meeting, curve_chords, meetings
from .cubics import Curve, points_at, tangents_on

CHORDS = 32  # evenly spaced chords of an arc, for its direction and turns
# near misses up to so many tolerances are reported; a larger distance is taken as intended
_NEAR = 4.0
_SHARE = 0.01  # default tolerance, relative to the median size of curves
_CORNER = np.cos(np.radians(30.0))  # a curve that turns at once by more has a corner


@dataclass(frozen=True)
class Arc:
    """The part of a curve from the node `a` to the node `b`."""

    curve: int
    a: int
    b: int
    path: Curve
    span: tuple[float, float]  # parameters of the ends
    ends: np.ndarray  # (2, 3): the two nodes
    points: np.ndarray = field(init=False)  # (CHORDS + 1, 3), evenly spaced

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", self.even(CHORDS))

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    def even(self, count: int) -> np.ndarray:
        """(count + 1, 3): evenly spaced points on the curve, which is moved to the nodes at its ends."""
        t, u = self.span
        fine = np.linspace(t, u, max(4 * count, int(np.ceil(STEPS * (u - t)))) + 1)
        steps = np.linalg.norm(np.diff(self._at(fine), axis=0), axis=1)
        way = np.concatenate([[0.0], np.cumsum(steps)])
        shares = np.linspace(0.0, 1.0, count + 1)
        points = self._at(np.interp(shares * way[-1], way, fine))
        shares = shares[:, None]
        start, end = self.ends - points[[0, -1]]
        return points + (1 - shares) * start + shares * end

    def _at(self, t: np.ndarray) -> np.ndarray:
        return points_at(self.path.pieces, t % self.path.end if self.path.closed else t)


@dataclass(frozen=True)
class Loose:
    """A part of a curve that encloses nothing and is left out, from `place` to its end there."""

    curve: int
    place: np.ndarray
    length: float


@dataclass(frozen=True)
class Network:
    curves: Sequence[Curve]
    nodes: np.ndarray  # (n, 3)
    arcs: list[Arc]
    tolerance: float
    crossings: int
    loose: list[Loose] = field(default_factory=list)
    misses: list[Meeting] = field(default_factory=list)  # nearer than four tolerances, but no nodes

    def degrees(self) -> np.ndarray:
        """(n,) int: number of arc ends at each node."""
        ends = [node for arc in self.arcs for node in (arc.a, arc.b)]
        return np.bincount(ends, minlength=len(self.nodes))


def usual_size(curves: Sequence[Curve]) -> float:
    """The median diagonal of the curves' bounding boxes."""
    boxes = [np.ptp(curve.pieces.reshape(-1, 3), axis=0) for curve in curves]
    return float(np.median(np.linalg.norm(boxes, axis=1)))


def network(curves: Sequence[Curve], tolerance: float = 0.0) -> Network:
    """The network of curves with at least one piece each. Curves meet where their distance is at most
    `tolerance`, a length; 0: a hundredth of the median size of curves.
    """
    tolerance = tolerance or _SHARE * usual_size(curves)
    found = meetings(curves, _NEAR * tolerance)
    met = [m for m in found if m.distance <= tolerance]
    stops = _Stops(curves, tolerance)
    for one in met:
        stops.join(stops.at(one.a, one.ta), stops.at(one.b, one.tb))
    nodes, visits = stops.settled()
    arcs = [arc for i, curve in enumerate(curves) for arc in _arcs(i, curve, visits[i], nodes)]
    arcs, loose = without_loose(arcs, len(nodes))
    seen = [{node for _, node in its} for its in visits]
    misses = [
        m
        for m in found
        if m.distance > tolerance and not _is_met(m, nodes[[*seen[m.a] & seen[m.b]]], tolerance)
    ]
    return Network(curves, nodes, arcs, tolerance, len(met), loose, misses)


class _Stops:
    """Places on curves; joined ones are one node."""

    def __init__(self, curves: Sequence[Curve], tolerance: float) -> None:
        self._curves, self._tolerance = curves, tolerance
        self._ids: list[dict[float, int]] = [{} for _ in curves]  # parameter: number of the place
        self._count = 0
        self._joined: list[tuple[int, int]] = []
        self._lengths = [_lengths(curve) for curve in curves]

    def at(self, curve: int, t: float) -> int:
        """The number of a place, new if the curve has none near it."""
        for known, number in self._ids[curve].items():
            if self._way(curve, known, t) <= self._tolerance:
                return number
        return self._new(curve, t)

    def _new(self, curve: int, t: float) -> int:
        self._ids[curve][t] = self._count
        self._count += 1
        return self._ids[curve][t]

    def _way(self, curve: int, t: float, u: float) -> float:
        table = self._lengths[curve]
        way = abs(float(np.interp(t, table[0], table[1]) - np.interp(u, table[0], table[1])))
        return min(way, table[1][-1] - way) if self._curves[curve].closed else way

    def join(self, a: int, b: int) -> None:
        self._joined.append((a, b))

    def settled(self) -> tuple[np.ndarray, list[list[tuple[float, int]]]]:
        """(nodes (n, 3), each curve's (parameter, node)); a node is the mean of its places."""
        for i, curve in enumerate(self._curves):
            for t in _own_stops(curve):
                self.at(i, t)
            if curve.closed and not self._ids[i]:
                self._new(i, 0.0)
            self._close(i, curve)
        pairs = np.array(self._joined, np.int64).reshape(-1, 2)
        number = core.module().arrays.connected_parts(self._count, pairs).tolist()
        count = 1 + max(number, default=-1)
        sums, counts = np.zeros((count, 3)), np.zeros(count)
        visits: list[list[tuple[float, int]]] = []
        for i, curve in enumerate(self._curves):
            mine = sorted((t, number[k]) for t, k in self._ids[i].items())
            visits.append(mine)
            for t, node in mine:
                sums[node] += points_at(curve.pieces, np.array([t]))[0]
                counts[node] += 1
        return sums / np.maximum(counts, 1)[:, None], visits

    def _close(self, i: int, curve: Curve) -> None:
        """Joins the two ends of one curve if they coincide."""
        if curve.closed:
            return
        ends = points_at(curve.pieces, np.array([0.0, curve.end]))
        if np.linalg.norm(ends[1] - ends[0]) <= self._tolerance < self._lengths[i][1][-1] / 2:
            self.join(self.at(i, 0.0), self.at(i, curve.end))


def _lengths(curve: Curve) -> tuple[np.ndarray, np.ndarray]:
    """Parameters, and the length of the curve up to each."""
    t, ends = curve_chords(curve)
    steps = np.linalg.norm(np.diff(ends, axis=0), axis=1)
    return t, np.concatenate([[0.0], np.cumsum(steps)])


def _own_stops(curve: Curve) -> list[float]:
    """Ends, and parameters where two pieces join at an angle."""
    count = len(curve.pieces)
    # not at the ends, where handles may have no length
    start, end = np.full(count, 1e-4), np.full(count, 1 - 1e-4)
    before = tangents_on(np.roll(curve.pieces, 1, axis=0), end)
    after = tangents_on(curve.pieces, start)
    size = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    turns = np.einsum("ij,ij->i", before, after) < _CORNER * size
    if curve.closed:
        return [float(i) for i in np.flatnonzero(turns)]
    turns[0] = True
    return [*(float(i) for i in np.flatnonzero(turns)), curve.end]


def _arcs(i: int, curve: Curve, visits: list[tuple[float, int]], nodes: np.ndarray) -> list[Arc]:
    pairs = list(zip(visits, visits[1:], strict=False))
    if curve.closed:
        pairs.append((visits[-1], (visits[0][0] + curve.end, visits[0][1])))
    return [Arc(i, a, b, curve, (t, u), nodes[[a, b]]) for (t, a), (u, b) in pairs]


def without_loose(arcs: list[Arc], count: int) -> tuple[list[Arc], list[Loose]]:
    """Removes arcs that end alone, repeatedly; returns the others, and the removed by loose end."""
    arcs = list(arcs)
    loose: list[Loose] = []
    gone: dict[int, tuple[np.ndarray, float, int]] = {}  # node: loose end beyond it, length, curve
    while True:
        degrees = np.bincount([n for arc in arcs for n in (arc.a, arc.b)], minlength=count)
        dangling = [arc for arc in arcs if degrees[arc.a] == 1 or degrees[arc.b] == 1]
        if not dangling:
            return arcs, loose + [Loose(curve, place, way) for place, way, curve in gone.values()]
        for arc in dangling:
            first = degrees[arc.a] == 1
            tip, foot = (arc.a, arc.b) if first else (arc.b, arc.a)
            place, way, curve = gone.pop(tip, (arc.points[0 if first else -1], 0.0, arc.curve))
            if curve != arc.curve:
                loose.append(Loose(curve, place, way))
                place, way = arc.points[0 if first else -1], 0.0
            if foot in gone:
                loose.append(Loose(arc.curve, place, way + arc.length))
            else:
                gone[foot] = (place, way + arc.length, arc.curve)
        chosen = set(map(id, dangling))
        arcs = [arc for arc in arcs if id(arc) not in chosen]


def _is_met(miss: Meeting, shared: np.ndarray, tolerance: float) -> bool:
    """Whether two curves are near only because they meet nearby, in a `shared` (k, 3) node."""
    return bool((np.linalg.norm(shared - miss.place, axis=1) <= 2 * _NEAR * tolerance).any())
