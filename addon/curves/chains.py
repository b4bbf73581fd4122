# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains of edges: of wires that are curves, and of the sides of triangles that a plane cuts."""

from collections.abc import Sequence

import numpy as np


def chains(edges: np.ndarray, marks: Sequence[bool] | np.ndarray) -> list[tuple[list[int], bool]]:
    """Vertices along each chain of `edges` (e, 2), and its mark. Chains end wherever the number of edges at
    a vertex is not two, or their marks differ; closed ones repeat the first vertex.
    """
    at: dict[int, list[int]] = {}
    pairs = edges.tolist()
    for k, pair in enumerate(pairs):
        for vertex in pair:
            at.setdefault(vertex, []).append(k)
    stops = {v for v, ks in at.items() if len(ks) != 2 or marks[ks[0]] != marks[ks[1]]}
    used = [False] * len(pairs)
    found = []
    for start in [*sorted(stops), *sorted(set(at) - stops)]:
        for first in at[start]:
            chain, k = [start], first
            while not used[k]:
                used[k] = True
                chain.append(sum(pairs[k]) - chain[-1])
                if chain[-1] in stops:
                    break
                k = next((n for n in at[chain[-1]] if n != k), k)
            if len(chain) > 1:
                found.append((chain, bool(marks[first])))
    return found
