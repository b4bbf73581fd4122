# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of spline patches and of their files, for operators and the command line."""

from math import radians
from typing import Any

from ..blender import Scene
from ..fields import choice, number, switch, whole

UNITS = (
    ("MM", "Millimetres", "Lengths in the file are in millimetres"),
    ("CM", "Centimetres", "Lengths in the file are in centimetres"),
    ("M", "Metres", "Lengths in the file are in metres"),
    ("IN", "Inches", "Lengths in the file are in inches"),
    ("FT", "Feet", "Lengths in the file are in feet"),
)
# metres in each
METRES = {"MM": 0.001, "CM": 0.01, "M": 1.0, "IN": 0.0254, "FT": 0.3048}


class PatchSettings:
    """Mix-in of annotations for operators."""

    fit_tolerance: number(
        "Tolerance",
        "Largest distance of a patch from the fair surface, as a share of its size; 0: 0.0001, near a scan half of the"
        " distance of 95 % of its points from the surface if that is more",
        min=0.0,
        max=0.1,
        precision=6,
    )
    fit_angle: number(
        "Angle",
        "Largest angle between two patches where there is no crease; 0: 0.05°, near a scan the angle of the tolerance"
        " over a mean edge of the cage if that is more",
        min=0.0,
        max=radians(10.0),
        precision=3,
        subtype="ANGLE",
    )
    fit_levels: whole(
        "Levels",
        "Levels before patches are fitted; 0: as many as the tolerance needs",
        min=0,
        max=8,
    )


class StepSettings(PatchSettings):
    unit: choice("Unit", "The unit of lengths in the file", UNITS)
    force: switch(
        "Write Faulty Faces",
        "Also writes surfaces that fold or turn too sharply for patches; those patches are red",
    )


def scale_to(unit: str, scene: Scene) -> float:
    """Units of the file in a Blender unit; 1 in scenes without units."""
    known: Any = scene.unit_settings
    return 1.0 if known.system == "NONE" else known.scale_length / METRES[unit]
