# SPDX-License-Identifier: GPL-3.0-or-later
"""The colours of values, such as curvature. Plain arrays, no Blender."""

import numpy as np

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


def percentiles(values: np.ndarray, *ranks: float) -> list[float]:
    """Floats at the `ranks` (0 to 100) of the finite `values`; zeros if there are none."""
    values = values[np.isfinite(values)]
    return [float(v) for v in np.percentile(values, ranks)] if len(values) else [0.0] * len(ranks)


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
    srgb = rgba[:, :3]
    rgba[:, :3] = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
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
