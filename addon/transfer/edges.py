# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges of a refined surface as pairs of vertices. No Blender."""

import numpy as np

from ..core import module


def edge_table(faces: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """(e, 2) int32 edges of the core's faces, and (corners,) the edge that leaves each corner."""
    arrays = module().arrays
    edges, corner_edges = arrays.edges_of(*arrays.joined_faces(faces))
    return edges.astype(np.int32), corner_edges.astype(np.int32)


def mark_pairs(edges: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """(e,) bool: which of the `edges` (e, 2) are among the vertex `pairs` (k, 2), in either direction."""
    keys = module().arrays.pair_keys
    return np.isin(keys(edges), keys(pairs))
