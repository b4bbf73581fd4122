# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps that change connectivity: they join borders, remove fins, split crowded edges and pinched
vertices, and reverse faces.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _native
from ..arrays import marked
from ..holes.edge_cuts import Cuts, cuts_for, pieces
from .state import State, all_pairs, numbered_parts


def mended(state: State, watchers: tuple[Any, Any]) -> tuple[State, dict[str, int]]:
    """The state after the core's mending, and the number of elements concerned by code."""
    found = _native.mended(state.points, state.corners, state.offsets, *watchers)
    if found is None:
        return state, {}
    nearer = np.where(found["corner_share"] > 0.5, 1, 0)
    corner = found["corner_origin"][np.arange(len(nearer)), nearer]
    lost = ~np.isfinite(state.points).all(axis=1)
    return state.replaced(
        # of no face, and nothing that is computed may meet them
        points=np.where(lost[:, None], 0.0, state.points) if lost.any() else state.points,
        corners=found["corners"].astype(np.int64),
        offsets=found["offsets"].astype(np.int64),
        face_origin=state.face_origin[found["face_origin"]],
        corner_origin=state.corner_origin[corner],
    ), dict(found["acts"])


def without_copies(state: State) -> tuple[State, int]:
    """The state without parts all of whose triangles lie on those of earlier parts, and the number of faces removed."""
    part, count = numbered_parts(state, all_pairs(state))
    if count < 2:
        return state, 0
    triangles = np.sort(_places(state.points)[state.triangles()], axis=1)
    owner = part[state.face_of[state.triangle_corners[:, 0]]]
    _, group = np.unique(triangles, axis=0, return_inverse=True)
    first = np.full(len(group), count)
    np.minimum.at(first, group.ravel(), owner)
    gone = ~marked(owner[first[group.ravel()] == owner], count)[part]
    return (state.without(gone), int(gone.sum())) if gone.any() else (state, 0)


def borders_joined(state: State) -> tuple[State, int]:
    """The state with coincident border edges joined, and the number of vertices removed. Borders that
    only touch in a point stay apart.
    """
    border = np.flatnonzero(state.sides.at_border)
    if not len(border):
        return state, 0
    ends = state.sides.ends[border]
    ids, rows = np.unique(ends, return_inverse=True)
    rows = rows.reshape(ends.shape)
    place = _places(state.points[ids])
    named = place[rows]
    turned = named[:, 0] > named[:, 1]
    rows[turned] = rows[turned, ::-1]
    named = np.sort(named, axis=1)
    order = np.lexsort(named.T)
    same = np.flatnonzero((named[order[1:]] == named[order[:-1]]).all(axis=1))
    one, other = rows[order[same]], rows[order[same + 1]]
    pairs = np.stack([one.ravel(), other.ravel()], axis=1)
    leads = ids[_native.joined(len(ids), pairs)]
    number = np.arange(len(state.points))
    number[ids] = leads
    count = int((leads != ids).sum())
    return (state.replaced(corners=number[state.corners]), count) if count else (state, 0)


def edges_cut(state: State, watchers: tuple[Any, Any]) -> tuple[State, int]:
    """The state with border edges cut at vertices that lie on them, up to slivers; and the number of these
    vertices. Triangles become triangles.
    """
    filler = _native.Filler(state.points, state.corners, state.offsets)
    loops = filler.find(*watchers)[0]
    cuts = cuts_for(state.points, state.corners, state.offsets, loops)
    return cut(state, cuts), sum(map(len, cuts.values()))


def cut(state: State, cuts: Cuts) -> State:
    """The state with these sides of faces cut at the vertices on them."""
    return state.in_pieces(pieces(state.corners, state.offsets, cuts)) if cuts else state


def _places(points: np.ndarray) -> np.ndarray:
    """(k,) numbers of points (k, 3); equal points have equal numbers."""
    order = np.lexsort(points.T)
    fresh = np.ones(len(points), bool)
    fresh[1:] = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    found = np.empty(len(points), np.int64)
    found[order] = np.cumsum(fresh) - 1
    return found


def without_fins(state: State) -> tuple[State, int]:
    """The state without fins, sheets attached to a surface, and the number of faces removed. At an edge
    with more than two faces the smallest part that ends in a border is removed, then the next, until two
    faces are left or no part ends in a border.
    """
    sides = state.sides
    if not len(sides.crowded):
        return state, 0
    part, count = numbered_parts(state, sides.pairs)
    of_side = part[state.face_of]
    area = np.bincount(part, np.linalg.norm(state.face_vectors, axis=1), count)
    ends = marked(of_side[sides.at_border], count)
    ends[np.argmax(area)] = False
    left = sides.uses.copy()
    crowded = sides.uses[sides.edge] > 2
    rows = np.flatnonzero(crowded)
    rows = rows[np.argsort(of_side[rows], kind="stable")]
    names, starts = np.unique(of_side[rows], return_index=True)
    edges_of = dict(zip(names.tolist(), np.split(sides.edge[rows], starts[1:]), strict=True))
    gone = np.zeros(count, bool)
    for name in sorted(edges_of, key=lambda p: (area[p], p)):
        edges = edges_of[name]
        if ends[name] and (left[edges] > 2).any():
            gone[name] = True
            np.subtract.at(left, edges, 1)
    faces = gone[part]
    return (state.without(faces), int(faces.sum())) if faces.any() else (state, 0)


def turned_alike(state: State, watchers: tuple[Any, Any]) -> tuple[State, int]:
    """The state with consistently oriented parts: in each part the minority of faces is reversed."""
    faces = _native.to_flip(state.points, state.corners, state.offsets, *watchers)
    return (state.turned(faces), len(faces)) if len(faces) else (state, 0)


def turned_out(state: State) -> tuple[State, int]:
    """The state with inward closed parts reversed, except hollows, which lie inside another part."""
    part, volume, closed = closed_parts(state)
    wrong = closed & (volume < 0.0)
    if not wrong.any():
        return state, 0
    hollow = [p for p in np.flatnonzero(wrong).tolist() if is_inside(state, part == p)]
    wrong[hollow] = False
    faces = np.flatnonzero(wrong[part])
    return (state.turned(faces), len(faces)) if len(faces) else (state, 0)


def closed_parts(state: State) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(m,) the part of each face, (p,) the volumes of the parts, and (p,) whether they are closed."""
    part, count = numbered_parts(state, state.sides.pairs)
    closed = np.ones(count, bool)
    alone = state.sides.uses[state.sides.edge] != 2
    closed[part[state.face_of[alone]]] = False
    return part, volumes(state, part, count), closed


def volumes(state: State, part: np.ndarray, count: int) -> np.ndarray:
    """(count,) volumes of the parts; meaningless for open ones."""
    rows = state.triangle_corners
    centred = state.points - state.points[state.corners].mean(axis=0)
    a, b, c = centred[state.corners[rows]].swapaxes(0, 1)
    return (
        np.bincount(part[state.face_of[rows[:, 0]]], (a * np.cross(b, c)).sum(axis=1), count) / 6.0
    )


SAMPLES = 8  # faces of a part that are tested for lying inside others


def is_inside(state: State, chosen: np.ndarray) -> bool:
    """Whether the faces `chosen`, (m,) bool, lie inside the others [Jacobson and others 2013]."""
    faces = np.flatnonzero(chosen)
    faces = faces[np.linspace(0, len(faces) - 1, min(SAMPLES, len(faces))).astype(int)]
    rows = state.triangle_corners
    others = state.points[state.corners[rows[~chosen[state.face_of[rows[:, 0]]]]]]
    if not len(others):
        return False
    low, high = others.min(axis=(0, 1)), others.max(axis=(0, 1))
    for face in faces.tolist():
        ids = state.corners[state.offsets[face] : state.offsets[face + 1]]
        place = state.points[ids].mean(axis=0)
        if (place <= low).any() or (place >= high).any():
            return False
        if abs(_winding(others - place)) <= 0.5:
            return False
    return True


def _winding(triangles: np.ndarray) -> float:
    """Winding number of triangles (t, 3, 3) about the origin [van Oosterom and Strackee 1983]."""
    a, b, c = triangles.swapaxes(0, 1)
    x, y, z = (np.sqrt((v * v).sum(axis=1)) for v in (a, b, c))
    above = (a * np.cross(b, c)).sum(axis=1)
    below = x * y * z + (a * b).sum(axis=1) * z + (b * c).sum(axis=1) * x + (c * a).sum(axis=1) * y
    return float(np.arctan2(above, below).sum() / (2.0 * np.pi))


def without_inner(state: State) -> tuple[State, int]:
    """The state without parts and walls inside others, and the number of faces removed."""
    part, volume, closed = closed_parts(state)
    area = np.bincount(part, np.linalg.norm(state.face_vectors, axis=1), len(volume))
    gone = np.zeros(len(part), bool)
    for name in np.argsort(area, kind="stable")[:-1].tolist():
        if closed[name] and volume[name] < 0.0:
            continue
        left = state.without(gone) if gone.any() else state
        mine = part[~gone] == name
        if is_inside(left, mine):
            gone |= part == name
    return (state.without(gone), int(gone.sum())) if gone.any() else (state, 0)


def vertices_split(state: State, every: bool) -> tuple[State, int]:
    """The state with a vertex for each fan of faces, and the number of vertices added. Fans meet where
    parts touch in a point, or where an edge has more than two faces; there the faces that bound one wedge
    are neighbours. A vertex all of whose fans end in borders of one part is split only with `every`,
    since filling the holes between the fans joins them.
    """
    sides = state.sides
    pairs = np.concatenate([sides.pairs, _wedges(state)])
    a, b = pairs.T
    opposite = sides.forward[a] != sides.forward[b]
    at_begin = np.where(opposite, sides.next[b], b)
    at_end = np.where(opposite, b, sides.next[b])
    links = np.concatenate([np.stack([a, at_begin], 1), np.stack([sides.next[a], at_end], 1)])
    fan = _native.joined(len(state.corners), np.ascontiguousarray(links, np.int64))
    leads = np.flatnonzero(fan == np.arange(len(fan)))
    leads = leads[np.argsort(state.corners[leads], kind="stable")]
    at = state.corners[leads]
    again = np.concatenate([[False], at[1:] == at[:-1]])
    if not again.any():
        return state, 0
    if not every:
        again &= ~_heals(state, pairs, fan, leads)[at]
    fresh = leads[again]
    number = state.corners.copy()
    of_fan = np.full(len(fan), -1)
    of_fan[fresh] = len(state.points) + np.arange(len(fresh))
    moved = of_fan[fan] >= 0
    number[moved] = of_fan[fan[moved]]
    return state.with_split(number, state.corners[fresh]), len(fresh)


def _heals(state: State, pairs: np.ndarray, fan: np.ndarray, leads: np.ndarray) -> np.ndarray:
    """(n,) whether all fans at a vertex end in borders and belong to one part."""
    sides = state.sides
    lone = np.flatnonzero(~marked(pairs, len(fan)))
    open_ = marked(fan[np.concatenate([lone, sides.next[lone]])], len(fan))
    heals = np.ones(len(state.points), bool)
    heals[state.corners[leads[~open_[leads]]]] = False
    heals[sides.ends[sides.uses[sides.edge] > 2]] = False
    part, _ = numbered_parts(state, pairs)
    of_corner = part[state.face_of]
    low = np.full(len(state.points), len(part))
    high = np.full(len(state.points), -1)
    np.minimum.at(low, state.corners, of_corner)
    np.maximum.at(high, state.corners, of_corner)
    return heals & (low == high)


def _wedges(state: State) -> np.ndarray:
    """(k, 2) pairs of sides at crowded edges that bound one wedge of the inside."""
    sides, found = state.sides, []
    for edge in sides.crowded.tolist():
        rows = sides.around(edge)
        angles, along = _angles_around(state, rows), sides.forward[rows]
        # The inside is behind each face: in order around the edge, before a face that runs along the
        # edge and after one that runs against it.
        ranked = [
            (angle, not way, row) for angle, way, row in zip(angles, along, rows, strict=True)
        ]
        ranked.sort(key=lambda t: (t[0], t[1]))
        ways = [not against for _, against, _ in ranked]
        first = next((k for k in range(len(ways)) if not ways[k] and ways[k - 1]), None)
        if first is None:
            continue
        waiting = None
        for k in range(first, first + len(ways)):
            row = ranked[k % len(ways)][2]
            if not ways[k % len(ways)]:
                waiting = row
            elif waiting is not None:
                found.append((waiting, row))
                waiting = None
    return np.array(found, np.int64).reshape(-1, 2)


def _angles_around(state: State, rows: np.ndarray) -> list[float]:
    """Angles of the faces of these sides around their common edge, radians, from the first one."""
    sides = state.sides
    begin, end = np.sort(sides.ends[rows[0]])
    axis = state.points[end] - state.points[begin]
    axis = axis / max(float(np.linalg.norm(axis)), 1e-300)
    found = []
    x: np.ndarray | None = None
    y = axis
    for row in rows.tolist():
        face = int(np.searchsorted(state.offsets, row, side="right")) - 1
        ids = state.corners[state.offsets[face] : state.offsets[face + 1]]
        way = (state.points[ids] - state.points[begin]).mean(axis=0)
        way = way - axis * (way @ axis)
        if x is None:
            x = way / max(float(np.linalg.norm(way)), 1e-300)
            y = np.cross(axis, x)
        found.append(float(np.arctan2(way @ y, way @ x)) % (2.0 * np.pi))
    return found
