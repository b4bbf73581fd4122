# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes a table of offsets: quads between stations and lines, triangles where these end."""

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Any

import numpy as np

from .. import core
from ..control_arrays import ControlArrays
from ..settings import Settings
from ..transfer.seams import half_axes
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
    sides = {side for face in faces for side in _sides(face)}
    knuckles = {frozenset(pair) for pair in creases} & sides
    marked = knuckles | sharp_middle(places, faces, knuckles)
    return HullMesh(places, faces, names, sorted((min(p), max(p)) for p in marked))


def sharp_in_middle(
    cage: ControlArrays, axis: str, settings: Settings
) -> tuple[list[frozenset[int]], np.ndarray, np.ndarray]:
    """The border edges in a plane such as `X`, and (b,) bool of each: whether both halves meet there at an angle
    without a crease, and whether it is creased.
    """
    places = np.roll(cage.positions, 1 - "XYZ".index(axis), axis=1)
    places[np.abs(places[:, 1]) <= core.module().halves.SNAP * np.ptp(places), 1] = 0.0
    faces = [face.tolist() for face in np.split(cage.corners, cage.offsets[1:-1])]
    marked = {frozenset(pair) for pair in core.crease_edges(cage, settings).tolist()}
    sharp = sharp_middle(places, faces, marked)
    border = map(frozenset, cage.border_edges.tolist())
    middle = [edge for edge in border if not places[list(edge), 1].any()]
    kinds = [(edge in sharp, edge in marked) for edge in middle]
    new, old = np.array(kinds, bool).reshape(-1, 2).T
    return middle, new, old


def why_round(cage: ControlArrays, settings: Settings) -> str:
    """What to crease if the symmetry plane rounds a sharp stem or keel, from which Flow Lines swell."""
    axis = settings.symmetry_plane
    is_rounded = axis != "NONE" and sharp_in_middle(cage, axis, settings)[1].any()
    return "crease stem and keel where they are sharp (Shift E, then 1)" if is_rounded else ""


def settings_of_whole(
    cages: Sequence[ControlArrays], axis: str, settings: Settings, holds_vertices: bool
) -> dict[str, Any]:
    """Settings by which the surfaces of halves are wholes; none if a cage is not half. Halves that meet at an angle
    keep it where their vertices are held.
    """
    if not all("XYZ".index(axis) in half_axes(cage) for cage in cages):
        return {}
    edges = [sharp_in_middle(cage, axis, settings) for cage in cages]
    is_sharp = holds_vertices and all((new | marked).all() for _, new, marked in edges)
    return {"symmetry_plane": "NONE" if is_sharp else axis, "copy_modifiers": True}


def sharp_middle(
    places: np.ndarray, faces: list[list[int]], knuckles: set[frozenset[int]]
) -> set[frozenset[int]]:
    """Edges in the middle plane where the sections of both halves meet at an angle."""
    beside: dict[frozenset[int], list[int]] = {}
    for index, face in enumerate(faces):
        for side in _sides(face):
            beside.setdefault(side, []).append(index)
    found, unknown, known = set(), set(), set()
    for middle in beside:
        if middle in knuckles or places[list(middle), 1].any():
            continue
        section, ends = _section(places, faces, beside, middle, knuckles)
        if _is_sharp(section, at_knuckle=ends in knuckles):
            found.add(middle)
        elif len(section) == 2 and len(ends) == 1:
            unknown.add(middle)
        else:
            known.add(middle)
    return found | _between_sharp(len(places), unknown, found | knuckles, known)


def _between_sharp(
    count: int,
    unknown: set[frozenset[int]],
    sharp: set[frozenset[int]],
    smooth: set[frozenset[int]],
) -> set[frozenset[int]]:
    """The runs of `unknown` edges, beside triangles, that join `sharp` edges and no `smooth` one."""
    pairs = np.array([[*edge] for edge in unknown], np.int64).reshape(-1, 2)
    run = core.module().arrays.connected_parts(count, pairs).tolist()
    at_sharp, at_smooth = ({run[v] for edge in of for v in edge} for of in (sharp, smooth))
    return {edge for edge in unknown if run[min(edge)] in at_sharp - at_smooth}


def _sides(face: list[int]) -> list[frozenset[int]]:
    return [frozenset(pair) for pair in zip(face, face[1:] + face[:1])]


def _section(
    places: np.ndarray,
    faces: list[list[int]],
    beside: dict[frozenset[int], list[int]],
    middle: frozenset[int],
    knuckles: set[frozenset[int]],
) -> tuple[np.ndarray, frozenset[int]]:
    """A section from an edge in the middle over up to two faces, but not over a knuckle: midpoints of
    sides (k, 2), outwards and away from the edge within the plane; and the last side.
    """
    points, face, side = [places[list(middle)].mean(axis=0)], -1, middle
    while len(points) < 3 and len(side) == 2 and side not in knuckles:
        following = [index for index in beside[side] if index != face]
        if not following:
            break
        face = following[0]
        side = frozenset(faces[face]) - side
        points.append(places[list(side)].mean(axis=0))
    v, w = middle
    along = (places[v] - places[w]) / np.linalg.norm(places[v] - places[w])
    section = np.array(points) - points[0]
    away = np.cross(along, [0.0, 1.0, 0.0])
    return np.column_stack([np.abs(section[:, 1]), section @ away]), side


def _is_sharp(section: np.ndarray, at_knuckle: bool) -> bool:
    """Whether the turn of both halves at the middle exceeds twice the turn explained by the curvature
    beside it. If a single face shows no curvature: at a knuckle the panel counts as straight; elsewhere
    a turn of more than a right angle is sharp.
    """
    steps = np.diff(section, axis=0) * [1.0, np.sign(section[1, 1])]
    slopes = np.arctan2(steps[:, 1], steps[:, 0])
    turn, explained = 2.0 * slopes[0], 0.0
    if len(steps) > 1:
        lengths = np.linalg.norm(steps, axis=1)
        explained = max(0.0, slopes[1] - slopes[0]) * lengths[0] / lengths.mean()
    elif not at_knuckle:
        explained = 0.25 * np.pi
    return bool(turn > 2.0 * explained)


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
