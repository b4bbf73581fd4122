# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons as the plain arrays that are read from a mesh."""

import numpy as np

from addon.core import ControlArrays


def polygons(positions, faces, sharp=None, boundary_edge=None):
    """From lists; `sharp`: pairs of vertices, `boundary_edge`: a mark for each edge, in their order."""
    sizes = np.array([len(face) for face in faces], np.int64)
    corners = np.concatenate([np.asarray(face, np.int32) for face in faces])
    following = np.concatenate([np.roll(face, -1) for face in faces])
    ends = np.sort(np.stack([corners, following], axis=1), axis=1)
    edges, corner_edges = np.unique(ends, axis=0, return_inverse=True)
    marked = None
    if sharp is not None:
        pairs = {tuple(sorted(pair)) for pair in sharp}
        marked = np.array([tuple(edge) in pairs for edge in edges.tolist()])
    return ControlArrays(
        positions=np.asarray(positions, float),
        edges=edges.astype(np.int32),
        corners=corners,
        corner_edges=corner_edges.ravel().astype(np.int32),
        offsets=np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        edge_crease=None,
        vertex_crease=None,
        sharp_edge=marked,
        boundary_edge=boundary_edge,
    )
