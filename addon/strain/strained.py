# SPDX-License-Identifier: GPL-3.0-or-later
"""The strain of one control mesh, and its outliers. Plain arrays, no Blender."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

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
