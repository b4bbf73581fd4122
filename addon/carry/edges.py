# SPDX-License-Identifier: GPL-3.0-or-later
"""Which control edge each refined edge is a piece of."""

import numpy as np

from .lattice import pair_keys, sides


def edge_origin(patch, control_edges, corner_edge, origin):
    """Writes the id of the control edge to `origin` (refined edges,) for all pieces of control edges in `patch`.

    `control_edges` (e, 2): their vertices; `corner_edge` (refined corners,): the refined edge that leaves each corner.
    """
    vertices, size = patch.faces.vertices, patch.faces.size
    if not len(vertices) or not len(control_edges):
        return
    keys = pair_keys(control_edges)
    order = np.argsort(keys)
    leaving = corner_edge[patch.start : patch.start + patch.fine.size].reshape(len(vertices), -1)
    n = int(np.sqrt(leaving.shape[1] // size))
    for side, (run, start, _) in enumerate(sides(size, n)):
        wanted = pair_keys(np.stack([vertices[:, side], vertices[:, (side + 1) % size]], axis=1))
        place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
        edge = order[place]
        is_edge = keys[edge] == wanted  # a cut through a polygon is none
        origin[leaving[is_edge][:, run * size + start]] = edge[is_edge, None]
