# SPDX-License-Identifier: GPL-3.0-or-later
"""From curvature to colour: plain arrays, no Blender."""

import numpy as np

from .measures import percentiles

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


def value_range(values, inner, signed, low, high):
    """(lowest, highest) value that gets a colour of its own: the percentiles `low` and `high` of `values` where `inner`.

    `signed`: as far below zero as above, so that flat is always the middle colour.
    """
    below, above = percentiles(values[inner], low, high)
    if signed:
        above = max(abs(below), abs(above))
        below = -above
    elif below >= above:
        below = min(below, 0.0)
    return (below, above) if above > below else (below, below + 1.0)


def colours(values, limits, signed):
    """(n, 4) float32 linear RGBA for (n,) `values` between the two `limits`; beyond them the end colours."""
    stops = np.array(_SIGNED if signed else _AMOUNT) / 255.0
    low, high = limits
    at = np.clip((values - low) / (high - low), 0.0, 1.0)
    if not signed:  # a sum of squares: its root has even steps
        at = np.sqrt(at)
    at *= len(stops) - 1
    rgba = np.ones((len(values), 4), np.float32)
    for channel in range(3):
        rgba[:, channel] = _linear(np.interp(at, np.arange(len(stops)), stops[:, channel]))
    return rgba


def _linear(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
