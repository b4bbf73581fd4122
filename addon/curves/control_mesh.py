# SPDX-License-Identifier: GPL-3.0-or-later
"""The control mesh over a network: fixed vertices on the curves, and free ones in the cells.

A cell of four sides gets a grid, by transfinite interpolation [Coons 1967; Gordon and Hall 1973]; any
other cell gets a grid at each corner, around a vertex in the middle.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .cells import Cell, Cells, border_arcs
from .network import Network

_ROUNDS = 200
# earlier counts are kept while edge lengths, relative to the wanted ones, differ by at most this factor
_KEPT = 2.5
_MOST = 16  # times the wanted number of edges: the limit for raising counts


def edge_counts(
    cells: Sequence[Cell], lengths: np.ndarray, edge: float, before: np.ndarray | None = None
) -> tuple[np.ndarray, bool]:
    """((e,) int, whether sides are as in `cells`): edges of about the length `edge` on arcs of
    `lengths` (e,). Opposite sides of four have equal numbers; all sides of other cells have the same
    even number.

    If there is no such solution, all arcs get the same even number, and each arc of a cell concerned
    must be a side. `before` (e,): numbers to keep while they still fit, so that a mesh keeps its faces
    while curves are edited.
    """
    wanted = np.maximum(np.rint(lengths / edge).astype(int), 2)
    if before is not None and len(before) == len(wanted):
        change = np.maximum(before, 1) / wanted
        if change.max() < _KEPT * change.min() and _KEPT**-0.5 < np.median(change) < _KEPT**0.5:
            wanted = before.copy()
    counts = wanted.copy()
    for _ in range(_ROUNDS):
        before = counts.copy()
        for cell in cells:
            sides = [[half // 2 for half in side] for side in cell.sides]
            for group in _equal(sides):
                _raise(counts, lengths, [sides[k] for k in group], even=len(sides) != 4)
        if (counts == before).all():
            return counts, True
        if counts.sum() > _MOST * wanted.sum():
            break
    most = int(np.median(wanted)) + 1
    return np.full(len(lengths), most // 2 * 2), False


def _equal(sides: list[list[int]]) -> list[list[int]]:
    if len(sides) == 1:
        return [[0]]
    return [[0, 2], [1, 3]] if len(sides) == 4 else [list(range(len(sides)))]


def _raise(counts: np.ndarray, lengths: np.ndarray, sides: list[list[int]], even: bool) -> None:
    """Adds edges to the sides with fewer, on their arcs with the longest edges."""
    goal = max(int(counts[side].sum()) for side in sides)
    if len(sides) == 1:
        goal += -goal % 4  # a loop without corners is divided into four sides
    elif even:
        goal += goal % 2
    for side in sides:
        while counts[side].sum() < goal:
            counts[max(side, key=lambda k: lengths[k] / counts[k])] += 1


_CALM = 0.05  # the inner square of a loop without corners: share of the way to straight sides


@dataclass(frozen=True)
class ControlMesh:
    points: np.ndarray  # (n, 3), vertices on curves first
    faces: np.ndarray  # (m, 4)
    held: np.ndarray  # (n,) bool: on a curve
    sharp: np.ndarray  # (k, 2) int: edges of sharp curves inside the surface
    cell_of_face: np.ndarray  # (m,) int
    counts: np.ndarray  # (e,) int: edges on each arc of the network


def control_mesh(found: Cells, per_side: int, before: np.ndarray | None = None) -> ControlMesh:
    """`per_side`: edges on shorter sides of cells; `before`: the `counts` of an earlier mesh."""
    network = found.network
    lengths = np.array([arc.length for arc in network.arcs])
    used = sorted({half // 2 for cell in found.cells for half in cell.halves})
    edge = _short_side(found.cells, lengths) / per_side
    counts, as_drawn = edge_counts(found.cells, lengths, edge, before)
    builder = _Builder(network, counts, used)
    for k, cell in enumerate(found.cells):
        if not as_drawn and len(cell.sides) not in (1, 4):
            cell = Cell([[half] for half in cell.halves])
        builder.fill(cell, k)
    points = np.concatenate(builder.points)
    faces = np.array(builder.faces, np.int64).reshape(-1, 4)
    held = np.arange(len(points)) < builder.on_curves
    borders = border_arcs(found.cells, network.arcs)
    marked = [k for k in used if network.curves[network.arcs[k].curve].sharp and k not in borders]
    pairs = [np.stack([builder.rows[k][:-1], builder.rows[k][1:]], axis=1) for k in marked]
    sharp = np.concatenate([np.zeros((0, 2), np.int64), *pairs])
    cells_of = np.array(builder.cells, np.int64)
    return _looking_up(_without_idle(ControlMesh(points, faces, held, sharp, cells_of, counts)))


def _looking_up(mesh: ControlMesh) -> ControlMesh:
    """The mesh, reversed if it is closed and oriented inwards, or open and oriented downwards."""
    a, b, c, d = mesh.points[mesh.faces].swapaxes(0, 1)
    areas = np.cross(c - a, d - b)
    pairs = np.sort(np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=-1).reshape(-1, 2))
    closed = (np.unique(pairs, axis=0, return_counts=True)[1] == 2).all()
    middle = mesh.points.mean(axis=0)
    out = np.einsum("ij,ij->", (a + b + c + d) / 4 - middle, areas) if closed else areas[:, 2].sum()
    return replace(mesh, faces=mesh.faces[:, ::-1]) if out < 0 else mesh


def _without_idle(mesh: ControlMesh) -> ControlMesh:
    """The mesh without nodes that are in no cell."""
    ids, faces = np.unique(mesh.faces, return_inverse=True)
    new = np.zeros(len(mesh.points), np.int64)
    new[ids] = np.arange(len(ids))
    faces = faces.reshape(mesh.faces.shape)
    return replace(
        mesh, points=mesh.points[ids], faces=faces, held=mesh.held[ids], sharp=new[mesh.sharp]
    )


def _short_side(cells: list[Cell], lengths: np.ndarray) -> float:
    """The length that three of four sides exceed: frames of a hull are longer than rails."""
    sides = [
        lengths[[half // 2 for half in side]].sum() / (4 if len(cell.sides) == 1 else 1)
        for cell in cells
        for side in cell.sides
    ]
    return float(np.quantile(sides, 0.25))


class _Builder:
    def __init__(self, network: Network, counts: np.ndarray, used: list[int]) -> None:
        self.points = [network.nodes]
        self.faces: list[list[int]] = []
        self.cells: list[int] = []
        self.rows: dict[int, np.ndarray] = {}  # vertices along each arc
        self._count = len(network.nodes)
        for k in used:
            arc = network.arcs[k]
            inner = arc.even(int(counts[k]))[1:-1]
            self.rows[k] = np.array([arc.a, *self._add(inner), arc.b])
        self.on_curves = self._count

    def _add(self, points: np.ndarray) -> np.ndarray:
        self.points.append(points)
        self._count += len(points)
        return np.arange(self._count - len(points), self._count)

    def _at(self, ids: np.ndarray) -> np.ndarray:
        return np.concatenate(self.points)[ids]

    def fill(self, cell: Cell, number: int) -> None:
        sides = [self._side(side) for side in cell.sides]
        if len(sides) == 1:
            quarter = (len(sides[0]) - 1) // 4
            self._round([sides[0][k * quarter : (k + 1) * quarter + 1] for k in range(4)])
        elif len(sides) == 4:
            self._grid(*sides)
        else:
            self._around(sides)
        self.cells += [number] * (len(self.faces) - len(self.cells))

    def _side(self, halves: list[int]) -> np.ndarray:
        rows = [self.rows[h // 2][:: -1 if h % 2 else 1] for h in halves]
        return np.concatenate([*(row[:-1] for row in rows), rows[-1][-1:]])

    def _grid(
        self, bottom: np.ndarray, right: np.ndarray, top: np.ndarray, left: np.ndarray
    ) -> None:
        """Sides are ids, in order around the cell."""
        top, left = top[::-1], left[::-1]
        inner = coons(*(self._at(ids) for ids in (bottom, right, top, left)))[1:-1, 1:-1]
        grid = np.empty((len(left), len(bottom)), np.int64)
        grid[0], grid[-1], grid[:, 0], grid[:, -1] = bottom, top, left, right
        grid[1:-1, 1:-1] = self._add(inner.reshape(-1, 3)).reshape(inner.shape[:2])
        quads = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1)
        self.faces += quads.reshape(-1, 4).tolist()

    def _around(self, sides: list[np.ndarray]) -> None:
        """A grid at each corner, between the midpoints of its sides and the centre of the cell."""
        half = (len(sides[0]) - 1) // 2
        middles = np.array([side[half] for side in sides])
        corners = np.array([side[0] for side in sides])
        # the centre of a Coons patch, for four sides
        centre = 2 * self._at(middles).mean(axis=0) - self._at(corners).mean(axis=0)
        middle = self._add(centre[None])[0]
        spokes = []
        for place in middles.tolist():
            way = np.linspace(self._at(np.array([place]))[0], centre, half + 1)[1:-1]
            spokes.append(np.array([place, *self._add(way), middle]))
        for k, side in enumerate(sides):
            before = sides[k - 1]
            self._grid(side[: half + 1], spokes[k], spokes[k - 1][::-1], before[half:])

    def _round(self, sides: list[np.ndarray]) -> None:
        """A loop without corners: a square in the middle, and a grid at each of its sides."""
        rim = self._at(np.array([side[0] for side in sides]))
        centre = self._at(np.concatenate([side[:-1] for side in sides])).mean(axis=0)
        count = len(sides[0]) - 1
        depth = max(1, count // 2)
        corners = self._add((rim + centre) / 2)
        spokes = []
        for k, side in enumerate(sides):
            way = np.linspace(rim[k], (rim[k] + centre) / 2, depth + 1)[1:-1]
            spokes.append(np.array([side[0], *self._add(way), corners[k]]))
        square = []
        for k, side in enumerate(sides):
            outer = self._at(side)
            bent = (outer + centre) / 2
            straight = np.linspace(bent[0], bent[-1], count + 1)
            inner = (1 - _CALM) * straight + _CALM * bent
            square.append(np.array([corners[k], *self._add(inner[1:-1]), corners[(k + 1) % 4]]))
        for k, side in enumerate(sides):
            self._grid(side, spokes[(k + 1) % 4], square[k][::-1], spokes[k][::-1])
        self._grid(*square)


def coons(bottom: np.ndarray, right: np.ndarray, top: np.ndarray, left: np.ndarray) -> np.ndarray:
    """(v, u, 3): blends four rows, `bottom` and `top` (u, 3), `left` and `right` (v, 3)."""
    u = np.linspace(0, 1, len(bottom))[None, :, None]
    v = np.linspace(0, 1, len(left))[:, None, None]
    rows = (1 - v) * bottom[None] + v * top[None]
    columns = (1 - u) * left[:, None] + u * right[:, None]
    corners = (1 - v) * ((1 - u) * bottom[0] + u * bottom[-1]) + v * (
        (1 - u) * top[0] + u * top[-1]
    )
    return rows + columns - corners
