# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings as callers write them, checked and turned into the core's."""

from __future__ import annotations

from math import isfinite

from numpy.typing import ArrayLike

from . import _native
from .arrays import index_array, numbers
from .errors import fairing_error


def native_options(**settings: object) -> _native.Options:
    """The core's options. Those that are not given keep their defaults, and so do those that are None.

    Raises FairingError BAD_OPTION and BAD_SHAPE, and TypeError for what is no setting.
    """
    options = _native.Options()
    for name, value in settings.items():
        if name not in CONVERTERS:
            raise TypeError(f"{name!r} is no setting; there are {', '.join(CONVERTERS)}")
        if value is not None or name not in OPTIONAL:
            setattr(options, name, CONVERTERS[name](name, value))
    return options


def crease_pairs(name: str, edges: ArrayLike):
    pairs = index_array(edges, name)
    if pairs.size and (pairs.ndim != 2 or pairs.shape[1] != 2):
        raise fairing_error("BAD_SHAPE", f"crease_edges has shape {pairs.shape}; it must be (k, 2).")
    return pairs.reshape(-1, 2)


def corner_ids(name: str, vertices: ArrayLike):
    return index_array(vertices, name).reshape(-1)


def region_faces(name: str, region: ArrayLike):
    faces = index_array(region, name)
    if faces.ndim != 1:
        raise fairing_error("BAD_SHAPE", f"region has shape {faces.shape}; it must be (r,), ids of faces.")
    return faces


def weight_array(name: str, weights: ArrayLike):
    array = numbers(weights, name, "iuf").astype(float)
    if array.ndim != 1 or not array.size:
        raise fairing_error("BAD_SHAPE", f"weights has shape {array.shape}; it must be (n,), one a vertex.")
    return array


def choice(options):
    members = options.__members__

    def chosen(name: str, value: object):
        if not isinstance(value, str) or value not in members:
            raise choice_error(name, value, tuple(members))
        return members[value]

    return chosen


def choice_error(name: str, value: object, options: tuple[str, ...]):
    listed = " or ".join(f'"{option}"' for option in options)
    return fairing_error("BAD_OPTION", f"{name} is {value!r}; it must be {listed}.")


def whole(name: str, value: object) -> int:
    try:
        number = value.__index__()
    except AttributeError:
        raise fairing_error("BAD_OPTION", f"{name} is {value!r}; it must be a whole number.") from None
    if not 0 <= number < 2**31 and not (name == "memory_limit" and 0 <= number < 2**63):
        raise fairing_error(
            "BAD_OPTION",
            f"{name} is {number}; it must be 0 or more" + (", and below 2**31." if number > 0 else "."),
        )
    return number


def real(name: str, value: object) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise fairing_error("BAD_OPTION", f"{name} is {value!r}; it must be a number.") from None
    if not isfinite(number):
        raise fairing_error("BAD_OPTION", f"{name} is {number}; it must be finite.")
    return number


def switch(name: str, value: object) -> bool:
    return bool(value)


CONVERTERS = {
    "levels": whole,
    "energy": choice(_native.Energy),
    "step_tolerance": real,
    "max_steps": whole,
    "metric_exponent": real,
    "chart_blend": real,
    "chart": choice(_native.Chart),
    "interpolation": choice(_native.Interpolation),
    "tolerance": real,
    "epsilon": real,
    "boundary": choice(_native.Boundary),
    "joint": choice(_native.Joint),
    "method": choice(_native.Method),
    "repair_orientation": switch,
    "relative_residual": real,
    "max_iterations": whole,
    "smoother_degree": whole,
    "sweeps": whole,
    "threads": whole,
    "memory_limit": whole,
    "measure": switch,
    "weights": weight_array,
    "crease_edges": crease_pairs,
    "crease_angle": real,
    "corner_vertices": corner_ids,
    "corner_angle": real,
    "region": region_faces,
}
OPTIONAL = ("weights", "crease_edges", "crease_angle", "corner_vertices", "corner_angle", "region")
