# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface half way between two that share a border."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .borders import Border, Foot, across, dot, unit_vectors


@dataclass(frozen=True)
class Halfway:
    """The mean of two borders, seen from the first; seen from the other it is the same surface."""

    own: Border
    other: Border

    def at(self, points: np.ndarray) -> Foot:
        """As Border.at() of the other: `inward` is the other's way."""
        own, other = self.own.at(points), self.other.at(points)
        ways = [across(foot, own.along) for foot in (own, other)]
        along = np.cross(ways[1], other.normal)
        # the borders run in opposite directions, unless the faces of one are flipped
        same = -np.sign(dot(np.cross(ways[0], own.normal), along))
        inward = unit_vectors(ways[1] - ways[0])
        bends = [
            np.einsum("ki,kij,kj->k", way, foot.bend, way) for way, foot in zip(ways, (own, other))
        ]
        return Foot(
            (own.point + other.point) / 2,
            unit_vectors(np.cross(along, inward)),
            inward,
            ((bends[1] + same * bends[0]) / 2)[:, None, None]
            * inward[:, :, None]
            * inward[:, None, :],
            own.along,
        )
