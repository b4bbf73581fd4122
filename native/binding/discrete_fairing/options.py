# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings as callers write them, turned into the core's.

SETTINGS lists them all, each with what checks and converts it. fair() has their defaults, types and
meaning; Solver takes the same. Ranges are the core's to check (native/fairing/options.cpp).
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import holds_bool, index_array, numbers
from .errors import fairing_error


def native_options(**settings: object) -> _native.Options:
    """The core's options; settings that are not given keep their defaults.

    Those of OPTIONAL may be None, which means the default too; of `interpolation` it is "approximate"
    where there is a tolerance or weights. Raises FairingError BAD_OPTION and BAD_SHAPE, and TypeError
    for a name that is no setting.
    """
    options, given = _native.Options(), {}
    for name, value in settings.items():
        if name not in SETTINGS:
            raise TypeError(f"{name!r} is no setting; there are {', '.join(SETTINGS)}")
        if value is not None or name not in OPTIONAL:
            given[name] = SETTINGS[name](name, value)
    if "interpolation" not in given and ("weights" in given or np.any(given.get("tolerance", 0))):
        given["interpolation"] = _native.Interpolation.approximate
    for name, value in given.items():
        setattr(options, name, value)
    return options


# Each converter takes the setting's name, for messages, and the caller's value.


def vertex_pairs(name: str, edges: ArrayLike) -> np.ndarray:
    """(k, 2) int64."""
    pairs = index_array(edges, name)
    if pairs.size and (pairs.ndim != 2 or pairs.shape[1] != 2):
        raise fairing_error("BAD_SHAPE", f"{name} has shape {pairs.shape}; it must be (k, 2).")
    return pairs.reshape(-1, 2)


def pairs_by_boundary(name: str, edges: Mapping[str, ArrayLike]) -> list[np.ndarray]:
    """Vertex pairs (k, 2) int64 for each of the core's boundaries, in its order."""
    modes = _native.Boundary.__members__
    if not isinstance(edges, Mapping) or not set(edges) <= set(modes):
        listed = " or ".join(f'"{mode}"' for mode in modes)
        raise fairing_error(
            "BAD_OPTION", f"{name} is {edges!r}; it must give vertex pairs by {listed}."
        )
    return [vertex_pairs(f'{name}["{mode}"]', edges.get(mode, ())) for mode in modes]


def corner_ids(name: str, vertices: ArrayLike) -> np.ndarray:
    """(c,) int64."""
    return index_array(vertices, name).reshape(-1)


def region_faces(name: str, region: ArrayLike) -> np.ndarray:
    """(r,) int64."""
    faces = index_array(region, name)
    if faces.ndim != 1:
        raise fairing_error(
            "BAD_SHAPE", f"region has shape {faces.shape}; it must be (r,), ids of faces."
        )
    return faces


def lengths(name: str, value: object) -> list[float] | np.ndarray:
    """One finite number for all vertices, or (n,) float64."""
    if isinstance(value, str) or not np.iterable(value):
        return [real(name, value)]
    array = numbers(value, name, "iuf").astype(float)
    if array.ndim != 1 or array.size < 2:
        raise fairing_error(
            "BAD_SHAPE",
            f"{name} has shape {array.shape}; it must be a number, or (n,), one for each vertex.",
        )
    return array


def weight_array(name: str, weights: ArrayLike) -> np.ndarray:
    """(n,) float64."""
    array = numbers(weights, name, "iuf").astype(float)
    if array.ndim != 1 or not array.size:
        raise fairing_error(
            "BAD_SHAPE", f"{name} has shape {array.shape}; it must be (n,), one for each vertex."
        )
    return array


def edges_with_sharpness(
    name: str, given: tuple[ArrayLike, ArrayLike]
) -> tuple[np.ndarray, np.ndarray]:
    """(k, 2) int64 and (k,) float64; one number serves for all edges."""
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise fairing_error("BAD_OPTION", f"{name} is {given!r}; it must be (edges, sharpness).")
    pairs = vertex_pairs(name, given[0])
    values = numbers(given[1], name, "iuf").astype(float)
    if values.shape not in ((), (len(pairs),)):
        raise fairing_error(
            "BAD_SHAPE",
            f"{name} has {len(pairs)} edges and sharpness of shape {values.shape}; "
            "it must be one number, or one for each edge.",
        )
    return pairs, np.broadcast_to(values, len(pairs)).copy()


def normal_rows(name: str, normals: ArrayLike) -> np.ndarray:
    """(3 n,) float64, of (n, 3)."""
    array = numbers(normals, name, "iuf").astype(float)
    if array.ndim != 2 or array.shape[1] != 3:
        raise fairing_error(
            "BAD_SHAPE",
            f"normals has shape {array.shape}; it must be (n, 3), one row for each vertex.",
        )
    return array.reshape(-1)


def choice(enum: type):
    """The converter of a setting whose values are the names of one of the core's enums."""
    members = enum.__members__
    listed = " or ".join(f'"{member}"' for member in members)

    def chosen(name: str, value: object):
        if not isinstance(value, str) or value not in members:
            raise fairing_error("BAD_OPTION", f"{name} is {value!r}; it must be {listed}.")
        return members[value]

    return chosen


def whole(name: str, value: object) -> int:
    """An integer of any type, from 0 to what the core's holds."""
    try:
        number = _number(value).__index__()
    except (AttributeError, TypeError):
        raise fairing_error(
            "BAD_OPTION", f"{name} is {value!r}; it must be a whole number."
        ) from None
    if not 0 <= number < 2**31 and not (name == "memory_limit" and 0 <= number < 2**63):
        raise fairing_error(
            "BAD_OPTION",
            f"{name} is {number}; it must be 0 or more"
            + (", and below 2**31." if number > 0 else "."),
        )
    return number


def _number(value: object) -> object:
    """The value; TypeError for True and False, which would pass for 1 and 0: weld=True is no length."""
    if holds_bool(value):
        raise TypeError
    return value


def real(name: str, value: object) -> float:
    """A finite number."""
    try:
        number = float(_number(value))
    except (TypeError, ValueError, OverflowError):
        raise fairing_error("BAD_OPTION", f"{name} is {value!r}; it must be a number.") from None
    if not isfinite(number):
        raise fairing_error("BAD_OPTION", f"{name} is {number}; it must be finite.")
    return number


def distance(name: str, value: object) -> float:
    """A finite number, 0 or more."""
    number = real(name, value)
    if number < 0:
        raise fairing_error("BAD_OPTION", f"{name} is {number}; it must be 0 or more, or None.")
    return number


def switch(name: str, value: object) -> bool:
    """Anything with a truth value."""
    try:
        return bool(value)
    except (TypeError, ValueError):
        raise fairing_error(
            "BAD_OPTION", f"{name} is {value!r}; it must be True or False."
        ) from None


SETTINGS = {
    "levels": whole,
    "energy": choice(_native.Energy),
    "metric_exponent": real,
    "chart_blend": real,
    "chart": choice(_native.Chart),
    "interpolation": choice(_native.Interpolation),
    "tolerance": lengths,
    "weights": weight_array,
    "limit": real,
    "edge_sharpness": edges_with_sharpness,
    "vertex_sharpness": weight_array,
    "epsilon": real,
    "pad_size": real,
    "normals": normal_rows,
    "tension": real,
    "crease_edges": vertex_pairs,
    "crease_angle": real,
    "corner_vertices": corner_ids,
    "corner_angle": real,
    "boundary": choice(_native.Boundary),
    "boundary_edges": pairs_by_boundary,
    "region": region_faces,
    "joint": choice(_native.RegionContinuity),
    "repair": choice(_native.Repair),
    "weld": distance,
    "method": choice(_native.Method),
    "relative_residual": real,
    "max_iterations": whole,
    "smoother_degree": whole,
    "step_tolerance": real,
    "max_steps": whole,
    "sweeps": whole,
    "threads": whole,
    "memory_limit": whole,
    "measure": switch,
}
OPTIONAL = (
    "interpolation",
    "weights",
    "edge_sharpness",
    "vertex_sharpness",
    "normals",
    "crease_edges",
    "crease_angle",
    "corner_vertices",
    "corner_angle",
    "boundary_edges",
    "region",
    "weld",
)
