# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes a table of offsets: quads between stations and lines, triangles where these end."""

from dataclasses import dataclass
from difflib import SequenceMatcher

import numpy as np

from .halves import sharp_middle, sides_of
from .offsets import Offset, Offsets, is_buttock, is_diagonal, is_sharp, is_waterline


@dataclass(frozen=True)
class HullMesh:
    """A half hull whose faces point outwards."""

    positions: np.ndarray  # (n, 3) metres
    faces: list[list[int]]
    names: list[str]  # (n,) names such as `station 4, WL 300`
    creases: list[tuple[int, int]]  # edges along knuckles, and along a sharp stem or keel

    @property
    def is_half(self) -> bool:
        """Whether it ends in the plane y = 0."""
        return bool(len(self.positions)) and bool((self.positions[:, 1] == 0.0).any())

    @property
    def is_crowded(self) -> bool:
        """Whether it is shorter than wide, as if stations 0, 1, 2 … of a table in cm were 1 cm apart."""
        return bool(np.ptp(self.positions[:, 0]) < 2.0 * np.abs(self.positions[:, 1]).max())


def hull_mesh(table: Offsets) -> HullMesh:
    """The mesh of a table; stations are sorted by position."""
    ladders = [
        _ladder([p for p in table.points if p.station == name], table) for name in table.stations
    ]
    ids: dict[tuple[str, tuple[float, float, float]], int] = {}
    positions: list[tuple[float, float, float]] = []
    names: list[str] = []
    rungs = []
    for ladder in sorted(ladders, key=_mean_x):
        rung = []
        for point in ladder:
            key = point.station, point.place
            if key not in ids:  # where lines meet in one point it has the first one's name
                ids[key] = len(positions)
                positions.append(point.place)
                names.append(point.name)
            rung.append((point.line, ids[key]))
        rungs.append(rung)
    outwards = sum(place[1] for place in positions) >= 0.0
    faces, creases = [], []
    for here, there in zip(rungs, rungs[1:]):
        faces += [face if outwards else face[::-1] for face in _strip(here, there)]
        after = dict(there)
        creases += [(v, after[line]) for line, v in here if is_sharp(line) and line in after]
    # above a bulb and below a rising keel, strips in the middle plane are no skin
    faces = [face for face in faces if any(positions[v][1] for v in face)]
    places = np.array(positions, float).reshape(-1, 3)
    sides = {side for face in faces for side in sides_of(face)}
    knuckles = {frozenset(pair) for pair in creases} & sides
    marked = knuckles | sharp_middle(places, faces, knuckles)
    return HullMesh(places, faces, names, sorted((min(p), max(p)) for p in marked))


def _mean_x(points: list[Offset]) -> float:
    return sum(p.place[0] for p in points) / len(points)


def _ladder(points: list[Offset], table: Offsets) -> list[Offset]:
    """A station's points from the keel to the sheer: in the table's order if all lines are named, by
    height if there are waterlines, by the angle seen from the top of the middle if there are buttocks
    or diagonals.
    """
    top = max(p.place[2] for p in points)
    if any(is_buttock(p.line) or is_diagonal(p.line) for p in points):
        return sorted(points, key=lambda p: np.arctan2(abs(p.place[1]), top - p.place[2]))
    if any(is_waterline(line) for line in table.lines):
        return sorted(points, key=lambda p: p.place[2])
    return sorted(points, key=lambda p: table.lines.index(p.line))


def _strip(here: list[tuple[str, int]], there: list[tuple[str, int]]) -> list[list[int]]:
    """Faces between two stations: joins lines that both have in the same order, and both ends."""
    lines = [line for line, _ in here], [line for line, _ in there]
    last = len(here) - 1, len(there) - 1
    blocks = SequenceMatcher(None, *lines, autojunk=False).get_matching_blocks()
    shared = [(b.a + k, b.b + k) for b in blocks for k in range(b.size)]
    joints = [(0, 0), *(joint for joint in shared if joint not in {(0, 0), last}), last]
    faces = []
    for (i, j), (m, n) in zip(joints, joints[1:]):
        a, b = [v for _, v in here[i : m + 1]], [v for _, v in there[j : n + 1]]
        faces += _between(a, b, at_top=(m, n) == last and len(joints) > 2)
    distinct = [list(dict.fromkeys(face)) for face in faces]
    return [face for face in distinct if len(face) > 2]


def _between(a: list[int], b: list[int], at_top: bool) -> list[list[int]]:
    """Quads, and a triangle for each line that only one side has, beside the profile at which it ends."""
    both = min(len(a), len(b)) - 1
    spare_a, spare_b = len(a) - 1 - both, len(b) - 1 - both
    shift_a, shift_b = (0, 0) if at_top else (spare_a, spare_b)
    quads = [
        [a[shift_a + k], a[shift_a + k + 1], b[shift_b + k + 1], b[shift_b + k]]
        for k in range(both)
    ]
    from_a, from_b = (both, both) if at_top else (0, 0)
    fans = [[a[from_a + k], a[from_a + k + 1], b[from_b]] for k in range(spare_a)]
    fans += [[a[from_a], b[from_b + k + 1], b[from_b + k]] for k in range(spare_b)]
    return quads + fans if at_top else fans + quads
