# SPDX-License-Identifier: GPL-3.0-or-later
"""The strain of one control mesh, its outliers, and those that look like a knuckle without a crease. Plain arrays, no
Blender.

A wrong offset is strained alone. Along a knuckle without a crease the surface would move to one side at vertex after
vertex: the most strained ones on that side form a chain of edges, or continue a crease.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..triangles import marked
from . import words


@dataclass(frozen=True)
class Strained:
    """A control mesh of n vertices, and the distance that the surface would move at each vertex if it
    were released, without the effects of borders on fair shapes and of worse neighbours.
    """

    positions: np.ndarray  # (n, 3) in the coordinates of the object
    directions: np.ndarray  # (n, 3) directions of these moves
    # (n,) in scene units, above zero outwards; NaN at corners and on straight borders
    lengths: np.ndarray
    # In scene units: strains of mere scatter, or of a fair shape between its vertices, are smaller.
    floor: float
    edge_length: float  # the mean, in scene units
    wrong: np.ndarray  # (k,) ids of the outliers, the worst first
    names: list[str] = field(default_factory=list)  # (n,) from a table of offsets; or empty
    # ids along a chain that suggests a missing crease
    knuckle: list[int] = field(default_factory=list)

    def name(self, index: int) -> str:
        """For example `station 4, WL 300`, or `vertex 31`."""
        return words.name(index, self.names)

    @cached_property
    def held(self) -> np.ndarray:
        """(h,) ids of the vertices with a strain."""
        return np.flatnonzero(~np.isnan(self.lengths))

    @cached_property
    def largest(self) -> float:
        """0 if no vertex is held."""
        return float(np.abs(self.lengths[self.held]).max(initial=0.0))

    def worst(self, count: int) -> np.ndarray:
        """(k,) ids, the largest strain first; at most `count`."""
        order = np.argsort(-np.abs(self.lengths[self.held]), kind="stable")
        return self.held[order][:count]


_LEAST = 3  # vertices in a row that are not a coincidence


def knuckle(
    lengths: np.ndarray,
    edges: np.ndarray,
    creased: np.ndarray,
    border: np.ndarray,
    points: np.ndarray,
) -> list[int]:
    """Ids along the longest chain, with the ends of creases and the border vertices that it reaches;
    empty if there is none.

    `lengths` (n,) strain, above zero outwards, NaN if a vertex is not held; `edges` (e, 2); `creased`,
    `border` (e,) bool; `points` (n, 3).
    """
    beside: dict[int, list[int]] = {}
    for v, w in edges[~creased].tolist():
        beside.setdefault(v, []).append(w)
        beside.setdefault(w, []).append(v)
    uses = np.bincount(edges[creased].ravel(), minlength=len(points))
    on_border = marked(edges[border].ravel(), len(points))
    crease_ends = (uses == 1) & ~on_border
    found: list[list[int]] = [[]]
    for side in (-1.0, 1.0):
        chain = _worst_in_a_row(side * lengths, beside)
        if not chain:
            continue
        ends = _run_into(chain, beside, crease_ends | on_border, points)
        whole = ends[:1] + chain + ends[1:]
        whole = [v for v in whole if v >= 0]
        if len(chain) >= _LEAST or (len(whole) >= _LEAST and crease_ends[whole].any()):
            found.append(whole)
    return max(found, key=len)


def _worst_in_a_row(lengths: np.ndarray, beside: dict[int, list[int]]) -> list[int]:
    """The vertices of largest positive `lengths`, as many as form a single chain, in its order."""
    order = np.argsort(-np.nan_to_num(lengths, nan=-np.inf), kind="stable")
    chain: list[int] = []
    near: dict[int, list[int]] = {}  # neighbours among the chosen vertices
    for v in order.tolist():
        if not lengths[v] > 0.0:
            break
        near[v] = [w for w in beside.get(v, ()) if w in near]
        for w in near[v]:
            near[w].append(v)
        if max(map(len, (near[w] for w in (v, *near[v])))) > 2:
            break  # later vertices cannot repair it
        chain = _walked(near) or chain
    return chain


def _walked(near: dict[int, list[int]]) -> list[int]:
    """The chain from the end with the lower id; empty if there are several chains, or a closed one."""
    walk = sorted(v for v, ways in near.items() if len(ways) < 2)[:1]
    while walk:
        ahead = [w for w in near[walk[-1]] if w not in walk[-2:]]
        if not ahead:
            break
        walk.append(ahead[0])
    return walk if len(walk) == len(near) else []


def _run_into(
    chain: list[int], beside: dict[int, list[int]], stops: np.ndarray, points: np.ndarray
) -> list[int]:
    """At both ends of the chain, the vertex that continues it most nearly straight, if it is one of the
    `stops`; else -1. A chain of one vertex continues to its two most nearly opposite neighbours.
    """
    if len(chain) == 1:
        near = beside.get(chain[0], [])
        pairs = [[a, b] for k, a in enumerate(near) for b in near[k + 1 :] if stops[a] and stops[b]]
        return min(pairs, key=lambda p: _cosine(points, p[0], chain[0], p[1]), default=[-1, -1])
    found = []
    for end, before in ((chain[0], chain[1]), (chain[-1], chain[-2])):
        near = [w for w in beside.get(end, ()) if w not in chain]
        ahead = min(near, key=lambda w: _cosine(points, w, end, before), default=-1)
        found.append(ahead if ahead >= 0 and stops[ahead] else -1)
    return found


def _cosine(points: np.ndarray, a: int, at: int, b: int) -> float:
    """Cosine of the angle at a vertex: -1 if straight."""
    there, back = points[a] - points[at], points[b] - points[at]
    return float(there @ back / max(np.linalg.norm(there) * np.linalg.norm(back), 1e-300))
