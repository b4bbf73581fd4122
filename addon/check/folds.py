# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges at which a surface folds back: it turns by more than a right angle, or another limit."""

from typing import Any

import numpy as np

from ..core import module
from ..transfer.attributes import AttributeTransfer, coarse_triangles
from ..transfer.edges import mark_pairs
from ..triangles import marked, unit


def folded(vertices: np.ndarray, triangles: np.ndarray, cosine: float = 0.0) -> np.ndarray:
    """(N,) bool: the ends of edges whose two triangles have normals with a cosine below `cosine`."""
    return marked(_folds(vertices, triangles, cosine)[0], len(vertices))


def outward_folds(vertices: np.ndarray, triangles: np.ndarray, cosine: float) -> np.ndarray:
    """(k, 2) the triangles at edges folded so, with the surface's inside between them."""
    _, sides = _folds(vertices, triangles, cosine)
    corners = vertices[triangles]
    ways = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outside = np.sign((corners[:, 0] * ways).sum())  # of a closed mesh
    middles = corners.mean(axis=1)
    apart = middles[sides[:, 1]] - middles[sides[:, 0]]
    return sides[outside * (apart * ways[sides[:, 0]]).sum(axis=1) < 0.0]


def folded_in_place(
    result: Any,
    vertices: np.ndarray,
    before: np.ndarray,
    transfer: AttributeTransfer,
    chosen: np.ndarray,
    joined: bool,
) -> np.ndarray:
    """(N,) bool: vertices at folds of the `chosen` control faces, (m,) bool, of the core's `result`,
    with its points at `vertices` (N, 3).

    `joined`: whether the faces must meet those around smoothly; otherwise any angle is right there.
    Creases do not count, nor do folds of the control mesh, which is at `before`, and of the faces at
    them.
    """
    polygon = np.concatenate([patch.faces.polygon for patch in transfer.patches])
    coarsest, owner = coarse_triangles(transfer, 0)
    theirs = chosen[polygon]
    edges, sides = _folds(before, coarsest)
    at = marked(edges[theirs[owner[sides]].all(axis=1)], len(vertices))
    excused = marked(owner[at[coarsest].any(axis=1)], len(polygon))
    edges, sides = _folds(vertices, coarsest)
    inside = theirs[owner[sides]]
    counted = inside.all(axis=1) & ~excused[owner[sides]].any(axis=1)
    if joined:
        counted |= inside.any(axis=1) & ~inside.all(axis=1)
    return marked(edges[counted & ~mark_pairs(edges, result.crease_edges)], len(vertices))


def _folds(
    vertices: np.ndarray, triangles: np.ndarray, cosine: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """(k, 2) the ends of the folded edges, and (k, 2) their triangles."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    normals = unit(np.cross(b - a, c - a))
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    keys = module().arrays.pair_keys(edges)
    order = np.argsort(keys, kind="stable")
    pairs = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    first, second = order[pairs], order[pairs + 1]
    against = (normals[first // 3] * normals[second // 3]).sum(axis=1) < cosine
    sides = np.stack([first, second], axis=1)[against] // 3
    return edges[first[against]], sides
