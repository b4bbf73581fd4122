# SPDX-License-Identifier: GPL-3.0-or-later
"""Which edges are creases and which vertices corners: plain arrays, no Blender. (Fold angles are the core's business.)"""

import numpy as np


def crease_edges(arrays, crease_threshold=None, use_sharp=False):
    """Vertex pairs (k, 2) int32 of the edges that are creased by `crease_threshold` at least or, with `use_sharp`, marked sharp.

    `crease_threshold` None ignores creases. A weight of 0 is never a crease, whatever the threshold. Edges without
    a face are left out: they carry no surface.
    """
    chosen = np.zeros(len(arrays.edges), bool)
    if crease_threshold is not None and arrays.edge_crease is not None:
        chosen |= _creased(arrays.edge_crease, crease_threshold)
    if use_sharp and arrays.sharp_edge is not None:
        chosen |= arrays.sharp_edge
    chosen &= _occurs(arrays.corner_edges, len(arrays.edges))
    return arrays.edges[chosen]


def corner_vertices(arrays, crease_threshold=None):
    """Vertices (c,) int32 with a vertex crease of `crease_threshold` at least; None ignores them. Loose ones are left out."""
    if crease_threshold is None or arrays.vertex_crease is None:
        return np.empty(0, np.int32)
    chosen = _creased(arrays.vertex_crease, crease_threshold) & _occurs(arrays.corners, len(arrays.positions))
    return np.flatnonzero(chosen).astype(np.int32)


def _creased(weights, threshold):
    return (weights > 0.0) & (weights >= np.float32(threshold))


def _occurs(ids, count):
    occurs = np.zeros(count, bool)
    occurs[ids] = True
    return occurs
