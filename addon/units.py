# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths as the scene says them."""

import bpy

from .blender import Scene


def length_text(scene: Scene, length: float, digits: int = 3) -> str:
    """`4.2 mm`: a `length` in scene units, with so many `digits`."""
    units = scene.unit_settings
    if units.system == "NONE":  # of which Blender's own function makes a crash
        return f"{length:.{digits}g}"
    return bpy.utils.units.to_string(
        units.system, "LENGTH", length * units.scale_length, precision=digits
    )
