# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts the callers' arrays to arrays that the core reads.

Callers may pass any memory layout, any integer or float type, and read-only arrays. The core reads
C-contiguous, aligned float64 and int64.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .errors import fairing_error


def vertex_array(vertices: ArrayLike, name: str = "vertices") -> np.ndarray:
    """(n, 3) float64, C-contiguous. Raises FairingError BAD_SHAPE."""
    array = numbers(vertices, name, "iuf")
    if array.size == 0 and array.ndim <= 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise fairing_error("BAD_SHAPE", f"{name} has shape {array.shape}; it must be (n, 3).")
    return plain(array, np.float64)


def shape_array(shapes: ArrayLike | Sequence[ArrayLike] | None, count: int) -> np.ndarray:
    """(k, n, 3) float64, C-contiguous. Raises FairingError BAD_SHAPE."""
    none = np.empty((0, count, 3))
    array = none if shapes is None else numbers(cast(ArrayLike, shapes), "shapes", "iuf")
    if array.ndim and not len(array):
        return none
    if array.shape[1:] != (count, 3):
        raise fairing_error(
            "BAD_SHAPE",
            f"shapes has shape {array.shape}; it must be (k, {count}, 3), one row for each vertex.",
        )
    return plain(array, np.float64)


def face_arrays(faces: ArrayLike | Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    """Corners and offsets, both int64: face f is corners[offsets[f]:offsets[f + 1]].

    Takes an (m, k) array, a list of polygons of any size, or the pair (corners, offsets) itself, a
    tuple of two flat NumPy arrays. Raises FairingError BAD_SHAPE.
    """
    if is_flat_pair(faces):
        corners, offsets = cast(tuple[np.ndarray, np.ndarray], faces)
        return index_array(corners, "face corners"), index_array(offsets, "face offsets")
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        return uniform_faces(index_array(faces, "faces"))
    if not hasattr(faces, "__len__"):
        raise fairing_error(
            "BAD_SHAPE", f"faces is {faces!r}; it must be (m, 3), (m, 4) or a list of polygons."
        )
    return polygon_list(cast(Sequence[Sequence[int]], faces))


def is_flat_pair(faces: object) -> bool:
    """Whether this is a tuple of two flat arrays that fit each other.

    Only arrays count: two triangles in a tuple, (0, 1, 2) and (0, 2, 3), could pass for the pair.
    """
    if not (isinstance(faces, tuple) and len(faces) == 2):
        return False
    if not all(isinstance(part, np.ndarray) and part.ndim == 1 for part in faces):
        return False
    corners, offsets = faces
    return len(offsets) > 0 and offsets[0] == 0 and offsets[-1] == len(corners)


def uniform_faces(array: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners and offsets of an (m, k) array, k >= 3."""
    if array.size == 0:
        return np.empty(0, np.int64), np.zeros(1, np.int64)
    if array.ndim != 2 or array.shape[1] < 3:
        raise fairing_error(
            "BAD_SHAPE",
            f"faces has shape {array.shape}; it must be (m, 3), (m, 4) or a list of polygons.",
        )
    count, size = array.shape
    return array.reshape(-1), np.arange(count + 1, dtype=np.int64) * size


def polygon_list(faces: Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    """Corners and offsets of a list of polygons, each a sequence of vertex ids."""
    try:
        sizes = np.fromiter((len(face) for face in faces), np.int64, len(faces))
    except TypeError:
        raise fairing_error(
            "BAD_SHAPE", "faces must be (m, 3), (m, 4) or a list of polygons."
        ) from None
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    parts = [index_array(face, "faces").reshape(-1) for face in faces]
    return np.concatenate(parts) if parts else np.empty(0, np.int64), offsets


def joined_faces(parts: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Corners and offsets of faces, each of the `parts` (m, k) of another size."""
    sizes = np.repeat([part.shape[1] for part in parts], [len(part) for part in parts])
    corners = np.concatenate([part.ravel() for part in parts])
    return corners, np.concatenate([[0], np.cumsum(sizes)])


def marked(ids: np.ndarray, count: int) -> np.ndarray:
    """(count,) bool: the elements with these ids."""
    found = np.zeros(count, bool)
    found[ids] = True
    return found


def pair_keys(pairs: np.ndarray) -> np.ndarray:
    """One number for each vertex pair, in either direction: (…, 2) integers → (k,) int64."""
    pairs = np.sort(pairs.astype(np.int64).reshape(-1, 2), axis=1)
    return pairs[:, 0] << 32 | pairs[:, 1]


def backwards(offsets: np.ndarray) -> np.ndarray:
    """(c,) the corners of all faces in the opposite order, from the same first ones."""
    starts, sizes = (np.repeat(of, np.diff(offsets)) for of in (offsets[:-1], np.diff(offsets)))
    return starts + (starts - np.arange(int(offsets[-1]))) % sizes


def following(offsets: np.ndarray) -> np.ndarray:
    """(c,) the next corner around the face, for each corner."""
    after, some = np.arange(1, int(offsets[-1]) + 1), offsets[1:] > offsets[:-1]
    after[offsets[1:][some] - 1] = offsets[:-1][some]
    return after


def edges_of(corners: np.ndarray, offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(e, 2) the edges of faces, as ascending vertex pairs, and (c,) the edge that leaves each corner."""
    sides = np.stack([corners, corners[following(offsets)]], axis=1)
    keys, corner_edges = np.unique(pair_keys(sides), return_inverse=True)
    return np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1), corner_edges.ravel()


def ranges(starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """The numbers start … end - 1 of every pair, one range after another."""
    sizes = ends - starts
    before = np.cumsum(sizes) - sizes
    return np.arange(int(sizes.sum())) + np.repeat(starts - before, sizes)


def fans(starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """(t, 3) corners of the triangles of faces, each a fan from the first of its corners start … end - 1."""
    first = np.repeat(starts, ends - starts - 2)
    second = ranges(starts + 1, ends - 1)
    return np.stack([first, second, second + 1], axis=1)


def face_vectors(points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(m, 3) normals of faces, whose lengths are twice the areas; zero for faces without corners."""
    sums, some = np.zeros((len(offsets) - 1, 3)), offsets[1:] > offsets[:-1]
    # from the first corner, so that rounding is that of the face's size
    first = np.repeat(offsets[:-1], np.diff(offsets))
    away = points[corners] - points[corners[first]]
    if some.any():
        turns = np.cross(away, away[following(offsets)])
        sums[some] = np.add.reduceat(turns, offsets[:-1][some])
    return sums


def index_array(values: ArrayLike, name: str) -> np.ndarray:
    """int64, C-contiguous. Raises FairingError BAD_SHAPE for anything but integers.

    Unsigned ids that do not fit become the largest int64, which is out of range too.
    """
    array = numbers(values, name, "iuf")
    if array.size and array.dtype.kind == "f":
        raise fairing_error("BAD_SHAPE", f"{name} has dtype {array.dtype}; it must hold integers.")
    if array.dtype == np.uint64:
        array = np.minimum(array, np.uint64(np.iinfo(np.int64).max))
    return plain(array, np.int64)


def has_masked(values: object) -> bool:
    """Whether an array, or one of a list of arrays, hides entries: NumPy would show them again."""
    if isinstance(values, list | tuple):
        return any(np.ma.is_masked(part) for part in values if isinstance(part, np.ndarray))
    return np.ma.is_masked(values)


def plain(array: np.ndarray, dtype: type) -> np.ndarray:
    """The array as C-contiguous, aligned and of a NumPy type; a copy only if it is not so already."""
    return np.require(array, dtype, ["C", "A"])


def holds_bool(values: object) -> bool:
    """Whether `values` is or contains a bool, which Python and NumPy would convert to a number."""
    if isinstance(values, list | tuple):
        return any(map(holds_bool, values))
    return isinstance(values, bool) or getattr(values, "dtype", None) == np.dtype(bool)


def numbers(values: ArrayLike, name: str, kinds: str) -> np.ndarray:
    """An array of one of the NumPy `kinds` of dtype. Raises FairingError BAD_SHAPE, with `name`."""
    if has_masked(values):
        raise fairing_error(
            "BAD_SHAPE", f"{name} has masked entries; fill them, or leave them out."
        )
    if holds_bool(values):
        raise fairing_error("BAD_SHAPE", f"{name} has True or False in it; it must hold numbers.")
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise fairing_error("BAD_SHAPE", f"{name} is ragged: {error}") from None
    if array.dtype.kind not in kinds:
        raise fairing_error("BAD_SHAPE", f"{name} has dtype {array.dtype}; it must hold numbers.")
    return array


def fixed_vertices(fixed: ArrayLike | None, count: int) -> np.ndarray:
    """(count,) bool. Raises FairingError BAD_OPTION."""
    stays = np.zeros(count, bool) if fixed is None else np.asarray(fixed)
    if stays.shape != (count,) or stays.dtype != bool:
        raise fairing_error("BAD_OPTION", f"fixed must be {count} bools, one a vertex.")
    return stays


def faces_by_vertex(
    corners: np.ndarray, offsets: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """(c,) the faces at each of `count` vertices, vertex after vertex, and (count + 1,) where those begin."""
    faces = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    starts = np.cumsum(np.bincount(corners + 1, minlength=count + 1))
    return faces[np.argsort(corners, kind="stable")], starts


def connected_parts(count: int, pairs: np.ndarray) -> np.ndarray:
    """(count,) int32: the connected part of each of `count` nodes; `pairs` (k, 2) connect them.

    Parts are numbered in the order of their first nodes.
    """
    leads = _native.joined(count, np.ascontiguousarray(pairs, np.int64).reshape(-1, 2))
    return np.unique(leads, return_inverse=True)[1].reshape(-1).astype(np.int32)
