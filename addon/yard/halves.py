# SPDX-License-Identifier: GPL-3.0-or-later
"""Halves that end in a symmetry plane: where both meet at an angle, and the settings of the whole."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import core
from ..control_arrays import ControlArrays
from ..settings import Settings
from ..transfer.seams import half_axes


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
        for side in sides_of(face):
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


def sides_of(face: list[int]) -> list[frozenset[int]]:
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
