# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths and curvatures as the scene says them."""

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


def curvature_text(scene: Scene, curvature: float, power: int = 1) -> str:
    """`2.5 /m`: a `curvature`, one over a length in scene units; `power` 2: over its square, `/m²`."""
    units = scene.unit_settings
    if units.system == "NONE":
        return f"{curvature:.3g}"
    name, metres = ("m", 1.0) if units.system == "METRIC" else ("ft", 0.3048)
    value = curvature * (metres / units.scale_length) ** power
    return f"{value:.3g} /{name}{'²' if power == 2 else ''}"
