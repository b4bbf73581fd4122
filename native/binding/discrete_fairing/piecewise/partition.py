# SPDX-License-Identifier: GPL-3.0-or-later
"""Assigns faces to pieces: METIS finds pieces of similar size with short seams."""

from __future__ import annotations

import numpy as np

from ..errors import fairing_error


def neighbours(side_edge: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """(k, 2): pairs of faces of the mesh that share an edge, each pair once.

    side_edge: (F, 4), the edges of control faces, -1 for none; polygon: (F,), their faces.
    """
    face, side = np.nonzero(side_edge >= 0)
    edge = side_edge[face, side]
    order = np.argsort(edge, kind="stable")
    edge, owner = edge[order], polygon[face[order]]
    same = edge[1:] == edge[:-1]
    pairs = np.stack([owner[:-1][same], owner[1:][same]], 1)
    pairs = np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1)
    return np.unique(pairs, axis=0)


def partition(pairs: np.ndarray, weights: np.ndarray, count: int) -> np.ndarray:
    """(m,) int32: the piece of each face, from 0 to count - 1 or less; the same on every call.

    pairs: (k, 2), neighbouring faces; weights: (m,), the number of refined faces of each.
    """
    if count == 1:
        return np.zeros(len(weights), np.int32)
    try:
        import pymetis
    except ImportError:
        raise fairing_error(
            "BAD_OPTION",
            "More than one piece needs the package pymetis, which cuts meshes: "
            'pip install "discrete-fairing[cluster]".',
        ) from None
    both = np.concatenate([pairs, pairs[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    starts = np.searchsorted(both[:, 0], np.arange(len(weights) + 1))
    graph = pymetis.CSRAdjacency(starts, both[:, 1])
    found = pymetis.part_graph(count, graph, vweights=weights)
    return in_order(np.asarray(found.vertex_part, np.int32))


def in_order(labels: np.ndarray) -> np.ndarray:
    """Renumbers pieces by their first face, without empty ones."""
    _, first, place = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[place]
