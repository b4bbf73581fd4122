# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a hull made whole and closed: mirrored, deck and transom ruled across. No Blender."""

from dataclasses import dataclass

import numpy as np

from ..core import module

# relative to the hull's size: the largest distance of vertices that count as in the middle plane
_NEAR = 1e-6


class NotHalf(ValueError):
    """Why a mesh is no half hull, as a sentence."""


@dataclass(frozen=True)
class Whole:
    """A closed hull; the half's own vertices and faces come first."""

    origin: np.ndarray  # (n,) the vertex of the half that each vertex is, or is the image of
    positions: np.ndarray  # (n, 3)
    corners: np.ndarray  # (c,)
    offsets: np.ndarray  # (m + 1,)
    rim: np.ndarray  # (k, 2) edges between hull and caps, and between deck and transom


def whole_hull(positions: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> Whole:
    """The closed hull of a half that ends in the plane y = 0; raises NotHalf."""
    if not len(corners):
        raise NotHalf("it has no faces")
    sizes = np.diff(offsets)
    half = positions.astype(float)
    middle = np.abs(half[:, 1]) <= _NEAR * np.ptp(half, axis=0).max(initial=0.0)
    half[middle, 1] = 0.0
    if (half[:, 1] < 0.0).any() and (half[:, 1] > 0.0).any():
        raise NotHalf("it crosses the plane Y = 0: only one half may be there")
    open_sides = module().joints.borders.border_edges(corners, offsets)[0]
    in_middle = middle[open_sides].all(axis=1)
    if not in_middle.any():
        raise NotHalf("no edge lies in the plane Y = 0: move the middle of the hull there")
    rim = open_sides[~in_middle]
    _require_ends(rim, middle)
    image = np.arange(len(half))
    sides = np.flatnonzero(~middle)
    image[sides] = len(half) + np.arange(len(sides))
    # from the same first corners, so that both sides are cut into triangles alike
    turned = corners[module().arrays.backwards(offsets)]
    mirrored = half[sides] * [1.0, -1.0, 1.0]
    caps = [list(dict.fromkeys((w, v, image[v], image[w]))) for v, w in rim.tolist()]
    all_corners = [corners, image[turned], *(np.array(cap) for cap in caps)]
    all_sizes = np.concatenate([sizes, sizes, np.array([len(cap) for cap in caps], int)])
    across = [(v, image[v]) for v in _turns(half, rim, middle).tolist()]
    edges = np.concatenate([rim, image[rim], np.array(across, int).reshape(-1, 2)])
    return Whole(
        np.concatenate([np.arange(len(half)), sides]),
        np.concatenate([half, mirrored]),
        np.concatenate(all_corners).astype(int),
        np.concatenate([[0], np.cumsum(all_sizes)]).astype(int),
        edges,
    )


def _require_ends(rim: np.ndarray, middle: np.ndarray) -> None:
    """Every chain of the rim must reach the middle; otherwise it is a hole in one side."""
    part = module().arrays.connected_parts(len(middle), rim)
    apart = int((~np.isin(part[rim[:, 0]], part[middle])).sum())
    if apart:
        raise NotHalf(
            f"{apart} open edges are at holes in its side: fill these first (Fill Hole Fair)"
        )


def _turns(half: np.ndarray, rim: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """Vertices of the rim where it turns by more than 45°, such as from the sheer to the transom."""
    after = dict(rim.tolist())
    found = []
    for v, w in rim.tolist():
        x = after.get(w)
        if x is None or middle[w]:
            continue
        a, b = half[w] - half[v], half[x] - half[w]
        if a @ b < np.cos(np.pi / 4) * np.linalg.norm(a) * np.linalg.norm(b):
            found.append(w)
    return np.array(found, int)
