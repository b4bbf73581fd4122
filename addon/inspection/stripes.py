# SPDX-License-Identifier: GPL-3.0-or-later
"""What stripes are, in numbers: plain arrays, no Blender.

A direction is seen at each point: that of the mirrored ray, or for isophotes that of the normal. Its
angle from the plane across the axis of the room makes a wave; where it is low the surface is dark.
"""

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any

# modes of inspection that show stripes
STRIPES = ("ZEBRA", "LINES", "ISOPHOTES")
LIGHT, DARK = (0.88, 0.88, 0.865), (0.012, 0.013, 0.016)  # linear

_LINE = 0.15  # of the distance between two reflection lines: how thick they are


@dataclass(frozen=True)
class Stripes:
    axis: tuple[float, float, float]  # of the room, a unit vector
    waves: float  # radians of the wave for one of the angle
    level: float  # the wave is dark below it, light above
    width: float  # half the width of the change, in the wave's height
    mirrored: bool  # whether the mirrored ray counts, not the normal
    by_view: bool  # whether the room turns with the view, not with the object


def stripes_of(mode: str, settings: Any) -> Stripes:
    """Of one of STRIPES and a scene's settings: stripes, direction, sharpness, fixed_to."""
    by_view = settings.fixed_to == "VIEW"
    a = settings.direction
    # upright is y for the view and z for the object
    return Stripes(
        axis=(sin(a), cos(a), 0.0) if by_view else (sin(a), 0.0, cos(a)),
        waves=2.0 * settings.stripes,
        level=-cos(pi * _LINE) if mode == "LINES" else 0.0,
        width=0.02 + (1.0 - settings.sharpness) * 0.98,
        mirrored=mode != "ISOPHOTES",
        by_view=by_view,
    )
