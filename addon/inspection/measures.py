# SPDX-License-Identifier: GPL-3.0-or-later
"""Angles of edges, shapes of faces, and the colours of curvature. Plain arrays, no Blender."""

import numpy as np

from ..core import ControlArrays
from .curvature import face_normals, faces_of_edges

# even steps from the lowest value to the highest, sRGB
_SIGNED = (
    (18, 44, 128),
    (52, 118, 196),
    (142, 196, 226),
    (236, 236, 230),
    (246, 182, 112),
    (220, 86, 52),
    (128, 12, 38),
)
_AMOUNT = (
    (238, 238, 230),
    (196, 222, 214),
    (128, 190, 190),
    (240, 206, 110),
    (236, 128, 60),
    (196, 44, 50),
    (96, 8, 54),
)

NEUTRAL = (0.15, 0.15, 0.15)  # linear; the colour of missing values


def fold_angles(arrays: ControlArrays) -> tuple[np.ndarray, np.ndarray]:
    """(e,) degrees between each edge's two faces as if oriented alike; (e,) bool: has two."""
    normals = face_normals(arrays.positions, arrays.corners, arrays.offsets)
    pair = faces_of_edges(arrays)
    if not len(normals):
        return np.zeros(len(pair)), np.zeros(len(pair), bool)
    first, second = normals[pair[:, 0]], normals[pair[:, 1]]
    second = second * np.where(_same_way(arrays), -1.0, 1.0)[:, None]
    # from the lengths of sum and difference, since arccos would lose half of its digits near 0°
    apart = np.linalg.norm(first - second, axis=1)
    together = np.linalg.norm(first + second, axis=1)
    has_area = (normals != 0.0).any(axis=1)
    inside = (arrays.edge_uses == 2) & has_area[pair].all(axis=1)
    return np.degrees(2.0 * np.arctan2(apart, together)), inside


def percentiles(values: np.ndarray, *ranks: float) -> list[float]:
    """Floats at the `ranks` (0 to 100) of the finite `values`; zeros if there are none."""
    values = values[np.isfinite(values)]
    return [float(v) for v in np.percentile(values, ranks)] if len(values) else [0.0] * len(ranks)


def _same_way(arrays: ControlArrays) -> np.ndarray:
    """(e,) bool: edges along which both faces run in the same direction."""
    forward = arrays.edges[arrays.corner_edges, 0] == arrays.corners
    total = np.bincount(arrays.corner_edges, weights=forward, minlength=len(arrays.edges))
    return total != 1


def value_range(values: np.ndarray, inner: np.ndarray, signed: bool) -> tuple[float, float]:
    """(lowest, highest) of the `inner` `values` without a few extremes; `signed`: symmetric about zero."""
    below, above = percentiles(values[inner], 2.0, 98.0)
    if signed:
        above = max(abs(below), abs(above))
        below = -above
    elif below >= above:
        below = min(below, 0.0)
    return (below, above) if above > below else (below, below + 1.0)


def colours_of(values: np.ndarray, limits: tuple[float, float], signed: bool) -> np.ndarray:
    """(n, 4) float32 linear RGBA for `values` (n,); beyond `limits` the end colours."""
    rgba = shades_of(values, limits, signed)
    rgba[:, :3] = _linear(rgba[:, :3])
    return rgba


def shades_of(values: np.ndarray, limits: tuple[float, float], signed: bool) -> np.ndarray:
    """The same for screens: (n, 4) float32 sRGBA."""
    stops = np.array(_SIGNED if signed else _AMOUNT) / 255.0
    low, high = limits
    at = np.clip((values - low) / (high - low), 0.0, 1.0)
    if not signed:  # the root of a sum of squares has even steps
        at = np.sqrt(at)
    at *= len(stops) - 1
    rgba = np.ones((len(values), 4), np.float32)
    for channel in range(3):
        rgba[:, channel] = np.interp(at, np.arange(len(stops)), stops[:, channel])
    return rgba


def _linear(srgb: np.ndarray) -> np.ndarray:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
