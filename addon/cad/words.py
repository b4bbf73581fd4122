# SPDX-License-Identifier: GPL-3.0-or-later
"""The quality of patches in words. No Blender."""

from collections.abc import Iterable, Sequence
from math import ceil, degrees, floor, log10

from ..units import Text, digits_of
from ..words import listed

_LISTED = 8  # faces


def short(value: float) -> str:
    """Two significant digits, or all before the point."""
    return digits_of(value, 2)


def faces_text(faces: Sequence[int]) -> str:
    """For example `Faces 4, 7 and 9`; of many faces the first few and `…`."""
    shown = [str(face) for face in faces[:_LISTED]]
    noun = "Face" if len(faces) == 1 else "Faces"
    return f"{noun} {', '.join(shown)}, …" if len(faces) > _LISTED else f"{noun} {listed(shown)}"


def miss_text(
    off: float, allowed: float, size: float, angle: float, most: float, told: Text
) -> str:
    """What faces miss and the cure, for example `0.05 mm off (0.01 mm is allowed), 0.5° at edges (0.05° is
    allowed): Tolerance 0.0005 and Angle 0.5° allow it`. `off`, `allowed` and `size` are lengths, formatted
    by `told`, `angle` and `most` radians.
    """
    missed, cures = [], []
    if off > allowed:
        missed.append(f"{told(off)} off ({told(allowed)} is allowed)")
        cures.append(f"Tolerance {short(rounded_up(off / size))}")
    if angle > most:
        missed.append(f"{short(degrees(angle))}° at edges ({short(degrees(most))}° is allowed)")
        cures.append(f"Angle {short(rounded_up(degrees(angle)))}°")
    verb = "allows" if len(cures) == 1 else "allow"
    return f"At most {listed(missed)}: {listed(cures)} {verb} it." if missed else ""


def rounded_up(value: float) -> float:
    """To two significant digits."""
    step = 10.0 ** (floor(log10(value)) - 1)
    return ceil(value / step) * step


def together(sentences: Iterable[str]) -> str:
    """The sentences joined, without empty ones."""
    return " ".join(filter(None, sentences))
