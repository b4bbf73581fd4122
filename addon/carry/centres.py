# SPDX-License-Identifier: GPL-3.0-or-later
"""What the centre of a split polygon gets: a weighted mean of the corners around it."""

import numpy as np


class Centres:
    """The centres of all fans. `members` (t,): their triangles among the control triangles, fan after fan."""

    def __init__(self, triangles, arrays):
        """`triangles`: ControlFaces of size 3; `arrays`: the input mesh."""
        n, c = len(arrays.positions), len(arrays.corners)
        fan = triangles.vertices[:, 2] >= n if triangles.size == 3 else np.zeros(0, bool)
        self.members = np.flatnonzero(fan)
        self._vertices = triangles.vertices[self.members, 0]
        self._corners = triangles.corners[self.members, 0]
        centre = triangles.corners[self.members, 2] - c
        self._starts = np.flatnonzero(np.diff(centre, prepend=-1))
        self.count = len(self._starts)
        self._sizes = np.diff(self._starts, append=len(centre))
        self._weights = self._area_weights(arrays.positions)

    def corner(self, values):
        """(c, w) values of input corners → (centres, w) float64."""
        return self._mean(values[self._corners])

    def point(self, values):
        """(n, w) values of control vertices → (centres, w) float64."""
        return self._mean(values[self._vertices])

    def lowest(self):
        """(centres,) int32 each: the vertex of lowest id around each centre, and its corner."""
        if not self.count:
            return np.empty(0, np.int32), np.empty(0, np.int32)
        fan = np.repeat(np.arange(self.count), self._sizes)
        first = np.lexsort((self._vertices, fan))[self._starts]
        return self._vertices[first], self._corners[first]

    def _mean(self, values):
        if not self.count:
            return np.empty((0, values.shape[1]))
        return np.add.reduceat(values * self._weights[:, None], self._starts, axis=0)

    def _area_weights(self, positions):
        """(members,) float64: with these the corners' mean is the area centroid, where the core puts the centre.

        A value that is linear in the plane of a polygon so stays linear. Centroids outside their corners' hull,
        which strongly warped polygons can have, give way to the plain mean.
        """
        plain = 1.0 / np.repeat(self._sizes, self._sizes)
        if not self.count:
            return plain
        points = positions[self._vertices]
        mean = np.add.reduceat(points * plain[:, None], self._starts, axis=0)
        arm = points - np.repeat(mean, self._sizes, axis=0)
        after = self._starts + self._sizes - 1
        step = np.arange(1, len(arm) + 1)
        step[after] = self._starts
        normal = np.cross(arm, arm[step])
        whole = np.repeat(np.add.reduceat(normal, self._starts, axis=0), self._sizes, axis=0)
        part = np.einsum("ij,ij->i", normal, whole) / np.maximum(np.einsum("ij,ij->i", whole, whole), 1e-300)
        before = np.empty_like(part)
        before[step] = part
        weights = (plain + part + before) / 3
        usable = np.logical_and.reduceat(weights >= 0, self._starts)
        return np.where(np.repeat(usable, self._sizes), weights, plain)
