# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex groups as arrays. Blender gives weights one by one only: this takes a second for a million of them."""

from dataclasses import dataclass
from itertools import chain

import numpy as np


@dataclass(frozen=True)
class VertexGroup:
    """A group with g members; a member may have the weight 0."""

    name: str
    lock_weight: bool
    vertices: np.ndarray  # (g,) int32
    weights: np.ndarray  # (g,) float32

    def dense(self, count):
        """(count,) float32: the weight of every vertex, 0 outside of the group."""
        weights = np.zeros(count, np.float32)
        weights[self.vertices] = self.weights
        return weights


def read_groups(source, mesh):
    """The vertex groups of the object `source`, with the members that they have in `mesh`: a list of VertexGroup."""
    groups = source.vertex_groups
    if not len(groups):
        return []
    flat = chain.from_iterable((v.index, g.group, g.weight) for v in mesh.vertices for g in v.groups)
    vertex, group, weight = np.fromiter(flat, np.float64).reshape(-1, 3).T
    order = np.argsort(group, kind="stable")
    starts = np.searchsorted(group[order], np.arange(len(groups) + 1))
    return [
        VertexGroup(
            g.name,
            g.lock_weight,
            vertex[order[begin:end]].astype(np.int32),
            weight[order[begin:end]].astype(np.float32),
        )
        for g, begin, end in zip(groups, starts, starts[1:])
    ]
