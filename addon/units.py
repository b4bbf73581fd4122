# SPDX-License-Identifier: GPL-3.0-or-later
"""Formats lengths and curvatures in scene units. No Blender."""

from collections.abc import Callable
from dataclasses import dataclass
from math import floor, isfinite, log10
from typing import Any, TypeAlias

Text: TypeAlias = Callable[[float], str]  # formats a length in scene units

DIGITS = 3  # of lengths
_ROUNDED = 1e-12  # of the longest of a list

# by the scene's name of a unit: the symbol, and metres in it; the longest first
_METRIC = {
    "KILOMETERS": ("km", 1e3),
    "METERS": ("m", 1.0),
    "CENTIMETERS": ("cm", 1e-2),
    "MILLIMETERS": ("mm", 1e-3),
    "MICROMETERS": ("µm", 1e-6),
}
_IMPERIAL = {
    "MILES": ("mi", 1609.344),
    "FEET": ("ft", 0.3048),
    "INCHES": ("in", 0.0254),
    "THOU": ("thou", 2.54e-5),
}


@dataclass(frozen=True)
class Units:
    """The units of a scene when they were read, since runs outlive scenes."""

    known: tuple[tuple[str, float], ...]  # symbols, and metres in each; empty: plain numbers
    scale: float  # metres in a scene unit
    least: float = 1.0  # of a unit, below which a length is in the next smaller one

    @classmethod
    def of(cls, scene: Any) -> "Units":
        settings = scene.unit_settings
        if settings.system == "NONE":
            return cls((), 1.0)
        named = _METRIC if settings.system == "METRIC" else _IMPERIAL
        # None if the scene chooses automatically: ADAPTIVE
        chosen = named.get(settings.length_unit)
        if not chosen:
            return cls(tuple(named.values()), settings.scale_length)
        # a new file is in metres, but 0.000092 m is no length that a designer can read
        small = named["MILLIMETERS" if named is _METRIC else "INCHES"]
        known = (chosen, small) if small[1] < chosen[1] else (chosen,)
        return cls(known, settings.scale_length, least=0.01)

    def lengths(self, longest: float, digits: int = DIGITS) -> Text:
        """A function that formats lengths in scene units, all in the one unit that suits the `longest`.
        Lengths that are rounding errors beside it are 0.
        """
        name, each = "", 1.0
        if self.known:
            metres = abs(longest) * self.scale or 1.0
            name, each = next(
                (unit for unit in self.known if not metres < self.least * unit[1]), self.known[-1]
            )

        def text(length: float) -> str:
            seen = 0.0 if abs(length) < _ROUNDED * abs(longest) else length * self.scale / each
            return f"{digits_of(seen, digits)} {name}".rstrip()

        return text

    def volume(self, volume: float) -> str:
        """A volume in cubed scene units, with its unit."""
        if not self.known:
            return digits_of(volume)
        cubic = volume * self.scale**3
        name, each = next(
            (u for u in self.known if (self.least * u[1]) ** 3 <= abs(cubic)), self.known[-1]
        )
        return f"{digits_of(cubic / each**3)} {name}³"


def length_text(scene: Any, length: float, digits: int = DIGITS) -> str:
    """For example `4.2 mm`: one `length` in scene units. For a list, use `Units.lengths`."""
    return Units.of(scene).lengths(length, digits)(length)


def digits_of(value: float, digits: int = DIGITS) -> str:
    """For example `0.000153`, `15.3`, `15321`: so many significant digits, and no exponent."""
    if not isfinite(value) or value == 0.0:
        return f"{value:g}"
    places = max(0, digits - 1 - floor(log10(abs(value))))
    text = f"{value:.{places}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def curvature_text(scene: Any, curvature: float, power: int = 1) -> str:
    """Such as `2.5 /m`: a `curvature` in scene units; `power` 2: over the square, `/m²`."""
    units = scene.unit_settings
    if units.system == "NONE":
        return f"{curvature:.3g}"
    name, metres = ("m", 1.0) if units.system == "METRIC" else ("ft", 0.3048)
    value = curvature * (metres / units.scale_length) ** power
    return f"{value:.3g} /{name}{'²' if power == 2 else ''}"
