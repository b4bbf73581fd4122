# SPDX-License-Identifier: GPL-3.0-or-later
"""Wide holes with a plane rim, as the side on which a scanned part stood, get a flat filling in the outermost
plane of the rim. It continues straight across gaps that run into the rim, which become holes of their own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..holes.filling import fill_holes
from .state import State

_FITS = 5  # of the plane, each to the vertices near the one before
_BOW = 1 / 16  # four times the sagitta of the way across a gap, over its length
# edges: a vertex nearer to the plane belongs to it, a farther one gets a foot there
_IN_PLANE = 0.25


def stood_on(state: State, holes: list[Any], settings: dict[str, Any]) -> tuple[State, int]:
    """The state with those of these holes filled that have a plane rim, and their number. A hole is a rim and
    those of its islands.
    """
    count = 0
    for hole in holes:
        loops = [np.asarray(loop) for loop in hole]
        plane = _Plane.of(state.points, loops)
        if 2 * sum(len(loop) for loop in plane.near) > sum(len(loop) for loop in loops):
            filled = _filled(state, plane, loops, settings)
            count += filled is not state
            state = filled
    return state, count


@dataclass(frozen=True, slots=True)
class _Plane:
    """The outermost plane of the loops of a hole, parallel to that which most of their vertices are near to."""

    normal: np.ndarray
    height: float
    edge: float  # mean length of the loops' edges
    near: list[np.ndarray]  # by loop, positions in it: vertices within an edge of the plane between

    @classmethod
    def of(cls, points: np.ndarray, loops: list[np.ndarray]) -> _Plane:
        rims = [points[loop] for loop in loops]
        sides = [np.linalg.norm(np.roll(rim, -1, axis=0) - rim, axis=1) for rim in rims]
        edge, every = float(np.concatenate(sides).mean()), np.concatenate(rims)
        centred = rims[0] - rims[0].mean(axis=0)
        normal = np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)
        normal /= max(float(np.linalg.norm(normal)), np.finfo(float).tiny)
        middle = float(np.median(every @ normal))
        for _ in range(_FITS):
            near = np.abs(every @ normal - middle) <= edge
            if near.sum() < 3:
                break
            mean = every[near].mean(axis=0)
            axis = np.linalg.svd(every[near] - mean, full_matrices=False)[2][2]
            normal = axis if axis @ normal > 0.0 else -axis
            middle = float(mean @ normal)
        heights = [rim @ normal for rim in rims]
        within = [np.flatnonzero(np.abs(height - middle) <= edge) for height in heights]
        top = max((float(h[at].max()) for h, at in zip(heights, within) if len(at)), default=middle)
        return cls(normal, top, edge, within)

    def feet(self, points: np.ndarray) -> np.ndarray:
        return points - np.outer(points @ self.normal - self.height, self.normal)

    def across(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Points between two feet, bowed outwards: on a straight line triangles would have no area."""
        way = b - a
        count = max(2, round(float(np.linalg.norm(way)) / self.edge))
        share = np.arange(1, count)[:, None] / count
        return a + share * way + _BOW * share * (1.0 - share) * np.cross(way, self.normal)


def _filled(
    state: State, plane: _Plane, loops: list[np.ndarray], settings: dict[str, Any]
) -> State:
    """The state with a wall from the loops to the plane, and triangles in the plane; unchanged if an edge would
    get more than two faces.
    """
    new: list[np.ndarray] = []
    rims: list[np.ndarray] = []
    ids: list[int] = []
    wall: list[list[int]] = []
    for loop, near in zip(loops, plane.near, strict=True):
        if len(near) < 3:
            continue
        feet = plane.feet(state.points[loop])
        depth = np.linalg.norm(feet - state.points[loop], axis=1)
        foot: dict[int, int] = {}
        for at in near.tolist():
            foot[at] = int(loop[at])
            if depth[at] > _IN_PLANE * plane.edge:
                foot[at] = len(state.points) + len(new)
                new.append(feet[at])
        rim: list[np.ndarray] = []
        for a, b in zip(near.tolist(), np.roll(near, -1).tolist(), strict=True):
            rim.append(feet[a])
            ids.append(foot[a])
            if b == (a + 1) % len(loop):
                face = list(dict.fromkeys([int(loop[a]), int(loop[b]), foot[b], foot[a]]))
                wall += [[face[0], *face[k : k + 2]] for k in range(1, len(face) - 1)]
                continue
            for point in plane.across(feet[a], feet[b]):
                rim.append(point)
                ids.append(len(state.points) + len(new))
                new.append(rim[-1])
        rims.append(np.array(rim))
    inside, triangles = _within(rims, plane, settings)
    known = np.concatenate([ids, len(state.points) + len(new) + np.arange(len(inside))])
    triangles = known[triangles]
    if not len(triangles):
        return state
    faces = np.concatenate([np.array(wall, np.int64).reshape(-1, 3), triangles])
    filled = state.extended(
        np.concatenate([state.points, np.array(new).reshape(-1, 3), inside]),
        np.concatenate([state.corners, faces.ravel()]),
        np.concatenate([state.offsets, state.offsets[-1] + 3 * np.arange(1, len(faces) + 1)]),
    )
    return filled if len(filled.sides.crowded) <= len(state.sides.crowded) else state


def _within(
    rims: list[np.ndarray], plane: _Plane, settings: dict[str, Any]
) -> tuple[np.ndarray, np.ndarray]:
    """New vertices, and triangles within these rims, whose vertices they number before the new ones. For
    the core the faces beyond the rims are a wall along the `normal`.
    """
    ring = np.concatenate(rims)
    width = float(np.linalg.norm(np.ptp(ring, axis=0)))
    here = np.arange(len(ring))
    loops = np.split(here, np.cumsum([len(rim) for rim in rims])[:-1])
    there = np.concatenate([np.roll(loop, -1) for loop in loops])
    wall = np.stack([there, here, here + len(ring), there + len(ring)], axis=1)
    # feet are closer together than the vertices
    dense = float(np.linalg.norm(ring[there] - ring, axis=1).mean()) / plane.edge
    filled = fill_holes(
        np.concatenate([ring, ring + width * plane.normal]),
        wall,
        holes=[loops],
        **(settings | {"joint": "position", "density": dense * settings.get("density", 1.0)}),
    )
    faces = [hole.faces for hole in filled.holes]
    triangles = np.concatenate(faces) if faces else np.empty((0, 3), np.int64)
    return filled.vertices[2 * len(ring) :], np.where(
        triangles < len(ring), triangles, triangles - len(ring)
    )
