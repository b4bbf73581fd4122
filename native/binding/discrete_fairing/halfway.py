# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface half way between two that share a border."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .borders import Border, Foot, dot, unit_vectors


@dataclass(frozen=True)
class Halfway:
    """The mean of two borders, seen from the first; seen from the other it is the same surface."""

    own: Border
    other: Border

    def at(self, points: np.ndarray) -> Foot:
        """As Border.at() of the other: `inward` is the other's way."""
        own, other = self.own.at(points), self.other.at(points)
        along = np.cross(other.inward, other.normal)
        # the borders run in opposite directions, unless the faces of one are flipped
        same = -np.sign(dot(np.cross(own.inward, own.normal), along))
        inward = unit_vectors(other.inward - own.inward)
        bend = (_across(other) + same * _across(own)) / 2
        return Foot(
            (own.point + other.point) / 2,
            unit_vectors(np.cross(along, inward)),
            inward,
            bend[:, None, None] * inward[:, :, None] * inward[:, None, :],
        )


def _across(foot: Foot) -> np.ndarray:
    return np.asarray(np.einsum("ki,kij,kj->k", foot.inward, foot.bend, foot.inward))
