# SPDX-License-Identifier: GPL-3.0-or-later
"""Units, and parts with names and colours, for all CAD files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._native import FairingError
from ..arrays import numbers
from ..converters import positive
from ..errors import fairing_error
from .patches import SplinePatches

# metres in each unit
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}


@dataclass(frozen=True)
class Part:
    patches: SplinePatches
    name: str
    colours: np.ndarray | None  # (3,) or (P, 3) float64, red, green and blue from 0 to 1


def cad_parts(
    patches: SplinePatches | Sequence[SplinePatches],
    scale: object,
    names: str | Sequence[str] | None,
    colours: ArrayLike | Sequence[ArrayLike | None] | None,
) -> list[Part]:
    """The parts of a file, scaled. Raises FairingError BAD_OPTION for values that cannot be written."""
    factor = positive("scale", scale)
    single = isinstance(patches, SplinePatches)
    found = [patches] if single else _listed("patches", patches)
    titles = _one_a_part("names", names, len(found), isinstance(names, str))
    shades = _one_a_part("colours", colours, len(found), colours is not None and single)
    return [
        Part(_scaled(own, factor, k), _name(title, k), _part_colours(shade, own))
        for k, (own, title, shade) in enumerate(zip(found, titles, shades), 1)
    ]


def _scaled(patches: object, factor: float, k: int) -> SplinePatches:
    """The patches times `factor`. Refuses numbers that are not finite, which no program reads."""
    if not isinstance(patches, SplinePatches):
        raise fairing_error(
            "BAD_OPTION", f"patches has {patches!r}; it must be the result of fit_patches()."
        )
    with np.errstate(over="ignore", invalid="ignore"):
        scaled = patches.transformed(np.diag([factor, factor, factor, 1.0]))
        scaled.size = patches.size * factor  # of which readers of the file take their tolerance
    arrays = (scaled.vertices, scaled.patch_points, scaled.edge_points)
    if not all(np.isfinite(array).all() for array in arrays):
        raise fairing_error(
            "BAD_OPTION",
            f"scale is {factor:g}, which leaves part {k} without finite coordinates.",
            cure="Give a smaller scale, or a larger unit.",
        )
    return scaled


def _listed(name: str, values: object) -> list:
    try:
        return list(values)  # type: ignore[call-overload]
    except TypeError:
        raise fairing_error(
            "BAD_OPTION", f"{name} is {values!r}; it must be a list, with one entry a part."
        ) from None


def _one_a_part(name: str, values: object, count: int, single: bool) -> list:
    found = [None] * count if values is None else [values] if single else _listed(name, values)
    if len(found) != count:
        raise fairing_error("BAD_OPTION", f"{name} has {len(found)} entries for {count} parts.")
    return found


def _name(title: object, k: int) -> str:
    """The title as text; halves of characters become the mark of an unknown one."""
    if title is not None and not isinstance(title, str):
        raise fairing_error("BAD_OPTION", f"names has {title!r} for part {k}; it must be text.")
    whole = (title or "").encode("utf-16", "surrogatepass").decode("utf-16", "replace")
    return whole.replace("\0", "\ufffd") or f"surface {k}"


def _part_colours(colours: ArrayLike | None, patches: SplinePatches) -> np.ndarray | None:
    if colours is None:
        return None
    try:
        array = numbers(colours, "colours", "iuf").astype(float)
    except FairingError as error:
        raise fairing_error("BAD_OPTION", str(error)) from None
    count = len(patches)
    if array.shape not in ((3,), (count, 3)) or not ((array >= 0) & (array <= 1)).all():
        raise fairing_error(
            "BAD_OPTION",
            f"colours has shape {array.shape}; it must be (3,) or ({count}, 3), from 0 to 1.",
        )
    return array
