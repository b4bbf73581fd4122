# SPDX-License-Identifier: GPL-3.0-or-later
"""The cells of a network: closed walks that take the leftmost arc at every node."""

from dataclasses import dataclass, replace

import numpy as np

from .network import Arc, Loose, Network, without_loose
from .tangent_planes import TangentPlanes

# Around a planar cell the walk turns by 360°, around the outside of a sheet by -360°, around a cap such
# as half a sphere by zero: walks that turn by less are open.
_LEAST_TURN = np.pi / 2
_CORNER = np.radians(30.0)  # a cell that turns by more has a corner there
# each of four arcs is a side, unless two continue each other within this angle
_OF_FOUR = np.radians(8.0)


@dataclass(frozen=True)
class Cell:
    """`sides`: half-edges along each, counter-clockwise: 2 k along the arc k, 2 k + 1 against."""

    sides: list[list[int]]

    @property
    def halves(self) -> list[int]:
        return [half for side in self.sides for half in side]


@dataclass(frozen=True)
class Cells:
    network: Network  # without arcs that enclose nothing
    cells: list[Cell]
    open: list[Cell]  # borders of the surface


def find_cells(network: Network, closed: bool = False) -> Cells:
    """The cells of a network; `closed`: the walk around the outside of a sheet is a cell too."""
    arcs, loose = list(network.arcs), list(network.loose)
    while True:
        found = replace(network, arcs=arcs, loose=loose)
        planes = TangentPlanes(found)
        walks = _walks(planes, 2 * len(arcs))
        bridges = {half // 2 for walk in walks for half in walk if half ^ 1 in walk}
        if not bridges:
            break
        loose += [Loose(arcs[k].curve, arcs[k].points[-1], arcs[k].length) for k in sorted(bridges)]
        kept = [arc for k, arc in enumerate(arcs) if k not in bridges]
        arcs, more = without_loose(kept, len(network.nodes))
        loose += more
    inner: list[Cell] = []
    outer: list[Cell] = []
    for walk in walks:
        turns = [planes.turn_between(h, n) for h, n in zip(walk, [*walk[1:], walk[0]], strict=True)]
        total = sum(turns) + sum(map(planes.turn_along, walk))
        cell = Cell(_sides(walk, turns))
        (inner if total >= _LEAST_TURN or closed else outer).append(cell)
    return Cells(found, inner, outer)


def _walks(planes: TangentPlanes, count: int) -> list[list[int]]:
    after: dict[int, int] = {}
    for node in range(len(planes.leaving)):
        order = planes.in_order(node)
        for place, half in enumerate(order):
            after[half ^ 1] = order[place - 1]  # the next one clockwise from the incoming one
    walks, seen = [], [False] * count
    for first in range(count):
        walk, half = [], first
        while not seen[half]:
            seen[half] = True
            walk.append(half)
            half = after[half]
        if walk:
            walks.append(walk)
    return walks


def _sides(walk: list[int], turns: list[float]) -> list[list[int]]:
    """Cuts a walk at its corners; `turns` (k,): at the end of each half-edge."""
    least = _OF_FOUR if len(walk) == 4 and min(turns) > _OF_FOUR else _CORNER
    ends = [k for k, turn in enumerate(turns) if turn > least]
    if not ends:
        return [walk]
    rolled = walk[ends[0] + 1 :] + walk[: ends[0] + 1]
    lengths = np.diff([*ends, ends[0] + len(walk)]).tolist()
    sides, at = [], 0
    for length in lengths:
        sides.append(rolled[at : at + length])
        at += length
    return sides


def border_arcs(cells: list[Cell], arcs: list[Arc]) -> set[int]:
    """Arcs with a cell on one side only."""
    uses = np.bincount([h // 2 for cell in cells for h in cell.halves], minlength=len(arcs))
    return {int(k) for k in np.flatnonzero(uses == 1)}
