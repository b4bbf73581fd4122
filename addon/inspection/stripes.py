# SPDX-License-Identifier: GPL-3.0-or-later
"""Stripes in numbers. Plain arrays, no Blender.

Each point has a direction: that of the mirrored ray, or for isophotes that of the normal. A wave of its
angle from the plane across the axis of the room is dark where it is low.
"""

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any

# modes of inspection that show stripes
STRIPES = ("ZEBRA", "LINES", "ISOPHOTES")
LIGHT, DARK = (0.88, 0.88, 0.865), (0.012, 0.013, 0.016)  # linear

_LINE = 0.15  # relative to the distance between two reflection lines: their thickness


@dataclass(frozen=True)
class Stripes:
    axis: tuple[float, float, float]  # of the room, a unit vector
    waves: float  # radians of the wave per radian of the angle
    level: float  # dark below it, light above
    width: float  # half the width of the transition, in the wave's height
    mirrored: bool  # whether the mirrored ray is used instead of the normal
    by_view: bool  # whether the room turns with the view instead of the object


def stripes_of(mode: str, settings: Any) -> Stripes:
    """The Stripes of a mode in STRIPES and a scene's settings: stripes, direction, sharpness, fixed_to."""
    by_view = settings.fixed_to == "VIEW"
    a = settings.direction
    # upright is y in the view and z in the object
    return Stripes(
        axis=(sin(a), cos(a), 0.0) if by_view else (sin(a), 0.0, cos(a)),
        waves=2.0 * settings.stripes,
        level=-cos(pi * _LINE) if mode == "LINES" else 0.0,
        width=0.02 + (1.0 - settings.sharpness) * 0.98,
        mirrored=mode != "ISOPHOTES",
        by_view=by_view,
    )
