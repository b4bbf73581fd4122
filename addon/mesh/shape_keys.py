# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys as arrays and plain values, read and written."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ..blender import Object
from .object import copy_drivers

SETTINGS = (
    "slider_min",
    "slider_max",
    "value",
    "mute",
    "interpolation",
    "vertex_group",
    "lock_shape",
)


@dataclass(frozen=True)
class ShapeKey:
    """One key; `relative_key`: the place of the key that it is relative to."""

    name: str
    relative_key: int
    settings: (
        dict  # by the names in SETTINGS that this Blender has, in an order that is safe to write
    )


@dataclass(frozen=True)
class ShapeKeys:
    """The k keys of a mesh with n vertices; the first is the reference key."""

    keys: tuple  # of k ShapeKey
    positions: np.ndarray  # (k, n, 3) float64
    use_relative: bool
    eval_time: float
    active: int
    show_only: bool

    @property
    def shapes(self) -> np.ndarray:
        """(k - 1, n, 3) float64: all but the first, which is the control mesh itself."""
        return self.positions[1:]


def read_shape_keys(source: Object, vertex_count: int) -> ShapeKeys | None:
    """The ShapeKeys of the object `source`, None if it has none, or if they are not of its
    `vertex_count` vertices.
    """
    keys = source.data.shape_keys
    if keys is None or not len(keys.key_blocks):
        return None
    blocks = list(keys.key_blocks)
    if any(len(block.data) != vertex_count for block in blocks):
        return None
    place = {block.name: i for i, block in enumerate(blocks)}
    return ShapeKeys(
        keys=tuple(_key(block, place) for block in blocks),
        positions=np.stack([_positions(block) for block in blocks]),
        use_relative=keys.use_relative,
        eval_time=keys.eval_time,
        active=source.active_shape_key_index or 0,
        show_only=source.show_only_shape_key,
    )


def _key(block: bpy.types.ShapeKey, place: dict[str, int]) -> ShapeKey:
    settings = {name: getattr(block, name) for name in SETTINGS if hasattr(block, name)}
    return ShapeKey(block.name, place[block.relative_key.name], settings)


def _positions(block: bpy.types.ShapeKey) -> np.ndarray:
    values = np.empty(3 * len(block.data), np.float32)
    block.data.foreach_get("co", values)
    return values.reshape(-1, 3).astype(np.float64)


def write_shape_keys(
    target: Object,
    keys: ShapeKeys,
    shapes: np.ndarray | Sequence[np.ndarray],
    source: Object | None = None,
) -> None:
    """Gives the object `target` the `keys` (ShapeKeys): the first has its mesh's own positions, the
    others `shapes`.

    `shapes`: k - 1 arrays (N, 3), or one array (k - 1, N, 3). Vertex groups have to be there
    already. `source`: the object whose keys they are, for their drivers.
    """
    blocks = [target.shape_key_add(name=key.name, from_mix=False) for key in keys.keys]
    for block, positions in zip(blocks[1:], shapes, strict=True):
        block.data.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    for block, key in zip(blocks, keys.keys):
        block.name = key.name
        block.relative_key = blocks[key.relative_key]
        for name, value in key.settings.items():
            setattr(block, name, value)
    owner: Any = target.data.shape_keys
    owner.use_relative = keys.use_relative
    owner.eval_time = keys.eval_time
    target.active_shape_key_index = keys.active
    target.show_only_shape_key = keys.show_only
    if source is not None and source.data.shape_keys is not None:
        copy_drivers(source.data.shape_keys, owner)
