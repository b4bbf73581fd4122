# SPDX-License-Identifier: GPL-3.0-or-later
"""Converters of settings: each takes a setting's name, for messages, and the caller's value."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf, isfinite
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .arrays import holds_bool, index_array, numbers
from .errors import fairing_error


def _require(is_right: bool, name: str, array: np.ndarray, shape: str) -> None:
    if not is_right:
        raise fairing_error("BAD_SHAPE", f"{name} has shape {array.shape}; it must be {shape}.")


def vertex_pairs(name: str, edges: ArrayLike) -> np.ndarray:
    """(k, 2) int64."""
    pairs = index_array(edges, name)
    _require(not pairs.size or pairs.shape[1:] == (2,), name, pairs, "(k, 2)")
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


def face_ids(name: str, given: ArrayLike) -> np.ndarray:
    """(r,) int64."""
    faces = index_array(given, name)
    _require(faces.ndim == 1, name, faces, "(r,), ids of faces")
    return faces


def lengths(name: str, value: object) -> list[float] | np.ndarray:
    """One finite number for all vertices, or (n,) float64."""
    if isinstance(value, str) or not np.iterable(value):
        return [real(name, value)]
    array = numbers(cast(ArrayLike, value), name, "iuf").astype(float)
    is_right = array.ndim == 1 and array.size > 1
    _require(is_right, name, array, "a number, or (n,), one for each vertex")
    return array


def weight_array(name: str, weights: ArrayLike) -> np.ndarray:
    """(n,) float64."""
    array = numbers(weights, name, "iuf").astype(float)
    _require(array.ndim == 1 and array.size > 0, name, array, "(n,), one for each vertex")
    return array


def edges_with_values(
    name: str, given: tuple[ArrayLike, ArrayLike]
) -> tuple[np.ndarray, np.ndarray]:
    """(k, 2) int64 and (k,) float64; a single number is repeated for all edges."""
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise fairing_error("BAD_OPTION", f"{name} is {given!r}; it must be (edges, values).")
    pairs = vertex_pairs(name, given[0])
    values = numbers(given[1], name, "iuf").astype(float)
    if values.shape not in ((), (len(pairs),)):
        raise fairing_error(
            "BAD_SHAPE",
            f"{name} has {len(pairs)} edges and values of shape {values.shape}; "
            "it must be one number, or one for each edge.",
        )
    return pairs, np.broadcast_to(values, len(pairs)).copy()


def normal_rows(name: str, normals: ArrayLike) -> np.ndarray:
    """(3 n,) float64, from normals (n, 3)."""
    array = numbers(normals, name, "iuf").astype(float)
    _require(array.shape[1:] == (3,), name, array, "(n, 3), one row for each vertex")
    return array.reshape(-1)


def choice(members: Mapping[str, Any]) -> Callable[[str, object], Any]:
    """The converter of a setting whose values are names, such as those of one of the core's enums."""
    listed = " or ".join(f'"{member}"' for member in members)

    def chosen(name: str, value: object) -> Any:
        if not isinstance(value, str) or value not in members:
            raise fairing_error("BAD_OPTION", f"{name} is {value!r}; it must be {listed}.")
        return members[value]

    return chosen


def whole(name: str, value: object) -> int:
    """An integer of any type, from 0 to the largest that the core stores."""
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


def _number(value: object) -> Any:
    """The value; TypeError for True and False, which Python converts to 1 and 0: weld=True is no length."""
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


def positive(name: str, value: object) -> float:
    """A finite number over 0."""
    number = real(name, value)
    if number <= 0:
        raise fairing_error("BAD_OPTION", f"{name} is {number}; it must be over 0.")
    return number


def size(name: str, value: object, most: float = inf) -> float:
    """A finite number, from 0 to `most`."""
    number = real(name, value)
    if not 0 <= number <= most:
        limit = "0 or more" if most == inf else f"from 0 to {most:g}"
        raise fairing_error("BAD_OPTION", f"{name} is {number}; it must be {limit}.")
    return number


def switch(name: str, value: object) -> bool:
    """Anything with a truth value."""
    try:
        return bool(value)
    except (TypeError, ValueError):
        raise fairing_error(
            "BAD_OPTION", f"{name} is {value!r}; it must be True or False."
        ) from None
