# SPDX-License-Identifier: GPL-3.0-or-later
"""The strain of one control mesh, and what of it counts as wrong. Plain arrays, no Blender."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

# of the scatter: of a thousand strains that are nothing but scatter, three are larger
_BEYOND = 3.0
_SCATTER = 1.4826  # standard deviation of a bell curve, over the median of its absolute values
# A vertex that is out of line makes its neighbours strain too: measured on even quads and triangles,
# by at most 0.47 of its own strain an edge away, and by 0.17, 0.06, 0.02 at more
_ECHO, _FADES = 0.55, 2.6
_REACH = 5  # edges


@dataclass(frozen=True)
class Strained:
    """A control mesh of n vertices, and how far the surface would spring away at each of them, were
    that one let go.
    """

    positions: np.ndarray  # (n, 3) in the coordinates of the object
    ways: np.ndarray  # (n, 3) of the surface, in the same
    # (n,) in scene units, above zero outwards; NaN at corners and on straight borders
    lengths: np.ndarray
    edges: np.ndarray  # (e, 2) vertex pairs
    edge_length: float  # the mean one, in scene units

    @cached_property
    def held(self) -> np.ndarray:
        """(h,) ids of the vertices that strain at all."""
        return np.flatnonzero(~np.isnan(self.lengths))

    @cached_property
    def floor(self) -> float:
        """What strains may have that are nothing but scatter, and the shape between its vertices; a
        median tells it, which a few wrong vertices do not change.
        """
        return floor_of(self.lengths)

    @cached_property
    def largest(self) -> float:
        """0 where no vertex is held."""
        return float(np.abs(self.lengths[self.held]).max(initial=0.0))

    @cached_property
    def wrong(self) -> np.ndarray:
        """(k,) ids of the vertices that are out of line, the worst first."""
        return out_of_line(self.lengths, self.edges)

    def worst(self, count: int) -> np.ndarray:
        """(k,) ids, the largest strain first; at most `count`."""
        return above(self.lengths, -1.0)[:count]


def floor_of(lengths: np.ndarray) -> float:
    """Three standard deviations of strains (n,), by their median; NaN does not count."""
    sizes = np.abs(lengths[~np.isnan(lengths)])
    return _BEYOND * _SCATTER * float(np.median(sizes)) if len(sizes) else 0.0


def above(lengths: np.ndarray, threshold: float) -> np.ndarray:
    """(k,) ids of the vertices that strain by more, the largest of the `lengths` (n,) first; NaN does
    not count.
    """
    sizes = np.where(np.isnan(lengths), -np.inf, np.abs(lengths))
    order = np.argsort(-sizes, kind="stable")
    return order[sizes[order] > threshold]


def out_of_line(lengths: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """(k,) ids of the vertices whose `lengths` (n,) are above the floor, and above the echo of those
    that strain more still; the largest first. `edges` (e, 2): vertex pairs.
    """
    floor = floor_of(lengths)
    found, echo = [], np.full(len(lengths), floor)
    neighbours = _Neighbours(edges, len(lengths))
    for vertex in above(lengths, floor).tolist():
        size = abs(float(lengths[vertex]))
        if size > echo[vertex]:
            found.append(vertex)
            for away, ring in enumerate(neighbours.rings(vertex, _REACH)):
                echo[ring] += size * _ECHO / _FADES**away
    return np.array(found, np.int64)


class _Neighbours:
    """The vertices that each of `count` vertices shares an edge with."""

    def __init__(self, edges: np.ndarray, count: int) -> None:
        ends = np.concatenate([edges, edges[:, ::-1]])
        self._other = ends[np.argsort(ends[:, 0], kind="stable"), 1]
        self._begin = np.searchsorted(np.sort(ends[:, 0]), np.arange(count + 1))

    def rings(self, vertex: int, count: int) -> Iterator[np.ndarray]:
        """Those one edge away, then those two away, and so on."""
        seen, ring = {vertex}, [vertex]
        for _ in range(count):
            near = {int(i) for v in ring for i in self._other[self._begin[v] : self._begin[v + 1]]}
            ring = sorted(near - seen)
            seen |= near
            yield np.array(ring, np.int64)
