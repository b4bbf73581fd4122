# SPDX-License-Identifier: GPL-3.0-or-later
"""Planes that cut a hull, and the sheet of its lines: profile, half-breadths, body plan."""

from dataclasses import dataclass, replace

import numpy as np

from .dxf import Label, Polyline

_GAP = 0.1  # between two views, relative to the hull's length
_TEXT = 0.01  # height of labels, relative to the hull's length


@dataclass(frozen=True)
class Plane:
    """All points p with normal · p = place."""

    name: str
    normal: tuple[float, float, float]
    place: float


@dataclass(frozen=True)
class Cut:
    """The curves (k, 3) in which one plane cuts a hull; closed ones repeat their first point."""

    plane: Plane
    curves: list[np.ndarray]

    def scaled(self, factor: float) -> "Cut":
        plane = replace(self.plane, place=factor * self.plane.place)
        return Cut(plane, [factor * curve for curve in self.curves])


def places(text: str, low: float, high: float, spacing: float, start: float) -> list[float]:
    """Positions listed, or every `spacing` from `start`, between the ends; 0: five to ten at round
    places. Raises ValueError. After semicolons a comma may be the decimal sign.
    """
    if text.strip():
        parts = text.replace(",", ".").split(";") if ";" in text else text.replace(",", " ").split()
        return [float(part) for part in parts if part.strip()]
    spacing = spacing or _round_step(high - low)
    if spacing <= 0.0:
        return []
    first = int(np.floor((low - start) / spacing)) + 1
    last = int(np.ceil((high - start) / spacing)) - 1
    return [start + spacing * k for k in range(first, last + 1)]


def _round_step(extent: float) -> float:
    """The smallest step of 1, 2 or 5 times a power of ten that fits at most ten times."""
    if extent <= 0.0:
        return 0.0
    power = 10.0 ** np.floor(np.log10(extent / 10.0))
    return float(next(step * power for step in (1, 2, 5, 10) if step * power >= extent / 10.0))


def sheet(
    title: str, stations: list[Cut], buttocks: list[Cut], waterlines: list[Cut]
) -> list[Polyline | Label]:
    """Profile (x, z), below it half-breadths (x, y), and beside the profile the body plan: the half
    nearer to low x on the right, the other one on the left. Each view has the grid of the other planes,
    with the stations' names below, in one frame with `title`.
    """
    points = np.concatenate([c for cut in (*stations, *buttocks, *waterlines) for c in cut.curves])
    low, high = points.min(axis=0), points.max(axis=0)
    length, beam = high[0] - low[0], np.abs(points[:, 1]).max()
    gap, text = _GAP * length, _TEXT * length
    middle = 0.5 * (low[0] + high[0])
    below, centre = low[2] - gap - beam, high[0] + gap + beam
    x, y, z = (np.array([c.plane.place for c in cuts]) for cuts in (stations, buttocks, waterlines))
    level, out = np.unique([low[2], *z]), np.unique([0.0, *np.abs(y)])
    drawn: list[Polyline | Label] = [
        *_grid((low[0], high[0]), (low[2], high[2]), x, level),
        *_grid((low[0], high[0]), (below, below + beam), x, below + out),
        *_grid((centre - beam, centre + beam), (low[2], high[2]), centre + np.r_[-out, out], level),
    ]
    for cut in stations:
        name = cut.plane.name.removeprefix("station ")
        drawn += [
            Label("TEXT", (cut.plane.place, bottom - 2.0 * text), text, name)
            for bottom in (low[2], below)
        ]
    for cut in buttocks:
        drawn += _view("BUTTOCKS", cut, (1, 0, 0), (0, 0, 1), (0.0, 0.0), text)
    for cut in waterlines:
        drawn += _view("WATERLINES", cut, (1, 0, 0), (0, 1, 0), (0.0, below), text)
    for cut in stations:
        side = 1 if cut.plane.place <= middle else -1
        drawn += _view("STATIONS", cut, (0, side, 0), (0, 0, 1), (centre, 0.0), text)
    corner = (low[0] - gap, below - gap)
    drawn.append(Label("TEXT", (corner[0] + text, corner[1] + text), 2.0 * text, title))
    around = _box(corner, (centre + beam + gap, high[2] + gap))
    return [*drawn, Polyline("FRAME", around, closed=True)]


def _box(low: tuple[float, float], high: tuple[float, float]) -> np.ndarray:
    (left, bottom), (right, top) = low, high
    return np.array([(left, bottom, 0), (right, bottom, 0), (right, top, 0), (left, top, 0)], float)


def _grid(
    across: tuple[float, float], up: tuple[float, float], x: np.ndarray, y: np.ndarray
) -> list[Polyline]:
    """Lines at each `x` over the range `up`, and at each `y` over `across`."""
    upright = [[(at, end, 0.0) for end in up] for at in x]
    level = [[(end, at, 0.0) for end in across] for at in y]
    return [Polyline("GRID", np.array(line)) for line in (*upright, *level)]


def opened(curve: np.ndarray) -> tuple[np.ndarray, bool]:
    """A closed curve (k, 3) without its last point, which repeats the first, and whether it is closed."""
    closed = len(curve) > 3 and bool((curve[0] == curve[-1]).all())
    return (curve[:-1] if closed else curve), closed


def half(curve: np.ndarray) -> list[np.ndarray]:
    """Parts of a polyline (k, 3) with y >= 0; the mirror image if there are none."""
    if (curve[:, 1] <= 0.0).all() and (curve[:, 1] < 0.0).any():
        return [curve * [1, -1, 1]]
    inside = curve[:, 1] >= 0.0
    change = np.flatnonzero(inside[1:] != inside[:-1])
    share = curve[change, 1] / (curve[change, 1] - curve[change + 1, 1])
    crossings = curve[change] + share[:, None] * (curve[change + 1] - curve[change])
    crossings[:, 1] = 0.0
    pieces = np.split(curve, change + 1)
    found = []
    for k, piece in enumerate(pieces):
        if not piece[0, 1] >= 0.0:
            continue
        before, after = crossings[k - 1 : k] if k else [], crossings[k : k + 1]
        found.append(np.array([*before, *piece, *after]))
    return [piece for piece in found if len(piece) > 1]


def _view(
    layer: str, cut: Cut, right: tuple, up: tuple, origin: tuple[float, float], text: float
) -> list[Polyline | Label]:
    axes = np.array([right, up, (0, 0, 0)], float).T
    drawn: list[Polyline | Label] = []
    for curve in (piece for whole in cut.curves for piece in half(whole)):
        drawn.append(Polyline(layer, *opened(curve @ axes + [*origin, 0.0])))
    if drawn:
        ends = [line.points[-1] for line in drawn if isinstance(line, Polyline)]
        x, y, _ = max(ends, key=lambda end: tuple(np.abs(end[::-1])))
        drawn.append(Label("TEXT", (float(x) + text, float(y)), text, cut.plane.name))
    return drawn
