# SPDX-License-Identifier: GPL-3.0-or-later
"""What callers pass, as the plain arrays that the core reads: any layout, any integer or float type, read-only too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .errors import fairing_error

MOST_LEVELS = 15  # as in check_options.cpp


def vertex_array(vertices: ArrayLike) -> np.ndarray:
    """(n, 3) float64, C-contiguous. Raises FairingError BAD_SHAPE."""
    array = numbers(vertices, "vertices", "iuf")
    if array.size == 0 and array.ndim <= 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise fairing_error("BAD_SHAPE", f"vertices has shape {array.shape}; it must be (n, 3).")
    return np.ascontiguousarray(array, dtype=np.float64)


def shape_array(shapes: ArrayLike | Sequence[ArrayLike] | None, count: int) -> np.ndarray:
    """(k, n, 3) float64, C-contiguous. Raises FairingError BAD_SHAPE."""
    none = np.empty((0, count, 3))
    array = none if shapes is None else numbers(shapes, "shapes", "iuf")
    if array.ndim and not len(array):
        return none
    if array.shape[1:] != (count, 3):
        raise fairing_error(
            "BAD_SHAPE", f"shapes has shape {array.shape}; it must be (k, {count}, 3), one row a vertex."
        )
    return np.ascontiguousarray(array, dtype=np.float64)


def face_arrays(faces: ArrayLike | Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    """Corners and offsets, both int64: face f is corners[offsets[f]:offsets[f + 1]].

    Takes an (m, k) array, a list of polygons of any size, or the pair (corners, offsets) itself, a tuple of two flat
    NumPy arrays. Raises FairingError BAD_SHAPE.
    """
    if is_flat_pair(faces):
        corners, offsets = faces
        return index_array(corners, "face corners"), index_array(offsets, "face offsets")
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        return uniform_faces(index_array(faces, "faces"))
    if not hasattr(faces, "__len__"):
        raise fairing_error(
            "BAD_SHAPE", f"faces is {faces!r}; it must be (m, 3), (m, 4) or a list of polygons."
        )
    return polygon_list(faces)


def is_flat_pair(faces: object) -> bool:
    """Arrays only: two triangles in a tuple, (0, 1, 2) and (0, 2, 3), could pass for corners and offsets."""
    if not (isinstance(faces, tuple) and len(faces) == 2):
        return False
    if not all(isinstance(part, np.ndarray) and part.ndim == 1 for part in faces):
        return False
    corners, offsets = faces
    return len(offsets) > 0 and offsets[0] == 0 and offsets[-1] == len(corners)


def uniform_faces(array: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    if array.size == 0:
        return np.empty(0, np.int64), np.zeros(1, np.int64)
    if array.ndim != 2 or array.shape[1] < 3:
        raise fairing_error(
            "BAD_SHAPE", f"faces has shape {array.shape}; it must be (m, 3), (m, 4) or a list of polygons."
        )
    count, size = array.shape
    return array.reshape(-1), np.arange(count + 1, dtype=np.int64) * size


def polygon_list(faces: Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    try:
        sizes = np.fromiter((len(face) for face in faces), np.int64, len(faces))
    except TypeError:
        raise fairing_error("BAD_SHAPE", "faces must be (m, 3), (m, 4) or a list of polygons.") from None
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    parts = [index_array(face, "faces").reshape(-1) for face in faces]
    return np.concatenate(parts) if parts else np.empty(0, np.int64), offsets


def index_array(values: ArrayLike, name: str) -> np.ndarray:
    """int64, C-contiguous; unsigned ids that do not fit stay out of range. Raises FairingError BAD_SHAPE."""
    array = numbers(values, name, "iuf")
    if array.size and array.dtype.kind == "f":
        raise fairing_error("BAD_SHAPE", f"{name} has dtype {array.dtype}; it must hold integers.")
    if array.dtype == np.uint64:
        array = np.minimum(array, np.uint64(np.iinfo(np.int64).max))
    return np.ascontiguousarray(array, dtype=np.int64)


def numbers(values: ArrayLike, name: str, kinds: str) -> np.ndarray:
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise fairing_error("BAD_SHAPE", f"{name} is ragged: {error}") from None
    if array.dtype.kind not in kinds:
        raise fairing_error("BAD_SHAPE", f"{name} has dtype {array.dtype}; it must hold numbers.")
    return array


def predicted_size(
    vertex_count: int,
    faces: ArrayLike | Sequence[Sequence[int]],
    levels: int,
    shapes: int = 0,
    energy: str = "thin_plate",
) -> dict[str, int]:
    """What a run would make and take, without running it (quads that will be split count as quads).

    Returns "vertices" and "triangles" of the refined surface, and "bytes", the peak of the run's own arrays.
    Raises FairingError BAD_SHAPE and BAD_OPTION.
    """
    if vertex_count < 0 or shapes < 0 or not 0 <= levels <= MOST_LEVELS:
        raise fairing_error(
            "BAD_OPTION",
            f"{vertex_count} vertices and {shapes} shapes at {levels} levels; it must be from 0, and 0 to "
            f"{MOST_LEVELS}.",
        )
    energies = _native.Energy.__members__
    if energy not in energies:
        listed = " or ".join(f'"{name}"' for name in energies)
        raise fairing_error("BAD_OPTION", f"energy is {energy!r}; it must be {listed}.")
    corners, offsets = face_arrays(faces)
    return _native.predicted_size(
        int(vertex_count), corners, offsets, int(levels), int(shapes), energies[energy]
    )
