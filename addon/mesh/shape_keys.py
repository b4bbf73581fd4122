# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys as arrays and plain values, read and written."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from .. import vertex_values
from ..blender import Mesh, Object, column
from ..errors import JobError
from .object import copy_drivers, session_key

SETTINGS = (
    "slider_min",
    "slider_max",
    "value",
    "mute",
    "interpolation",
    "vertex_group",
    "lock_shape",
)


EASED = "Eased"  # the shape key written by easing


@dataclass(frozen=True)
class ShapeKey:
    """One key; `relative_key`: the index of the key that it is relative to."""

    name: str
    relative_key: int
    # by the names in SETTINGS that this version of Blender has, in an order that is safe to write
    settings: dict


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
    """The ShapeKeys of `source`; None without, or if they do not have `vertex_count`."""
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
    return column(block.data, "co", width=3).astype(np.float64)


def influences(
    keys: ShapeKeys, weights: Callable[[str], np.ndarray]
) -> dict[int, float | np.ndarray]:
    """The influence of each key but the first, by index, from its slider. The shape is the first key plus
    the other keys' differences times their influences, each a number or one a vertex. `weights`: (n,) of a
    vertex group by its name. Raises JobError for absolute keys, which the time mixes.
    """
    if keys.show_only:
        return {keys.active: 1.0} if keys.active else {}
    if not keys.use_relative:
        raise JobError(
            "Switch on Relative for the shape keys (Object Data), or apply their mix: they are absolute, and only Blender "
            "mixes such keys."
        )
    found: dict[int, float | np.ndarray] = {}
    for place, key in enumerate(keys.keys):
        value = 0.0 if key.settings["mute"] else key.settings["value"]
        if not (place and value) or place == key.relative_key:
            continue
        group = key.settings["vertex_group"]
        share = value * weights(group) if group else value
        for at, part in ((place, share), (key.relative_key, -share)):
            if at:
                found[at] = found.get(at, 0.0) + part
    return found


def mixed_positions(source: Object, mesh: Mesh, positions: np.ndarray) -> np.ndarray:
    """(n, 3): `positions` of the `mesh` of `source` or, in Object Mode, those of its mix of shape keys."""
    keys = None if source.mode == "EDIT" else read_shape_keys(source, len(positions))
    if keys is None:
        return positions
    groups = source.vertex_groups
    whole = np.ones(len(positions))
    shares = influences(
        keys, lambda name: vertex_values.factors(source, mesh, name) if name in groups else whole
    )
    shape = keys.positions[0].copy()
    for place, share in shares.items():
        shape += np.reshape(share, (-1, 1)) * (keys.positions[place] - keys.positions[0])
    return shape


def key_positions(source: Object, name: str, vertex_count: int) -> np.ndarray | None:
    """(n, 3) positions of the key `name`; None if there is none with `vertex_count` vertices."""
    keys = read_shape_keys(source, vertex_count)
    names = [key.name for key in keys.keys] if keys else []
    return keys.positions[names.index(name)] if keys and name in names else None


def write_shape_keys(
    target: Object,
    keys: ShapeKeys,
    shapes: np.ndarray | Sequence[np.ndarray],
    source: Object | None = None,
) -> None:
    """Gives the object `target` the `keys`: the first has its mesh's own positions, the others
    `shapes`.

    `shapes`: k - 1 arrays (N, 3), or one array (k - 1, N, 3). Vertex groups must exist already.
    `source`: the object with these keys, for their drivers.
    """
    blocks = [target.shape_key_add(name=key.name, from_mix=False) for key in keys.keys]
    for block, positions in zip(blocks[1:], shapes, strict=True):
        block.data.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    for block, key in zip(blocks, keys.keys):
        _set_up(block, key, blocks[key.relative_key])
    owner: Any = target.data.shape_keys
    owner.use_relative = keys.use_relative
    owner.eval_time = keys.eval_time
    target.active_shape_key_index = keys.active
    target.show_only_shape_key = keys.show_only
    if source is not None and source.data.shape_keys is not None:
        copy_drivers(source.data.shape_keys, owner)


def _set_up(block: bpy.types.ShapeKey, key: ShapeKey, relative: bpy.types.ShapeKey) -> None:
    block.name = key.name
    block.relative_key = relative
    for name, value in key.settings.items():
        setattr(block, name, value)


def add_shape_key(target: Object, key: ShapeKey, relative: str, away: np.ndarray) -> None:
    """Gives `target` another `key`, `away` (N, 3) from the key `relative`, or from the first."""
    if target.data.shape_keys is None:
        target.shape_key_add(name="Basis", from_mix=False)
    keys: Any = target.data.shape_keys
    blocks = keys.key_blocks
    base = blocks.get(relative) or blocks[0]
    block = target.shape_key_add(name=key.name, from_mix=False)
    block.data.foreach_set("co", np.float32(_positions(base) + away).ravel())
    _set_up(block, key, base)


def put_key(target: Object, name: str, positions: np.ndarray) -> None:
    """Gives `target`, in Object Mode, the key `name` with `positions` (n, 3) at full value."""
    if target.data.shape_keys is None:
        target.shape_key_add(name="Basis", from_mix=False)
    keys: Any = target.data.shape_keys
    block = keys.key_blocks.get(name) or target.shape_key_add(name=name, from_mix=False)
    block.data.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    block.relative_key = keys.key_blocks[0]
    block.mute, block.value = False, 1.0
    target.data.update()


@dataclass(frozen=True)
class KeyAnimation:
    """The animation of a mesh's shape keys, kept while the keys are replaced."""

    spare: int  # key of a copy of the mesh, with its keys and their drivers

    @classmethod
    def of(cls, mesh: Mesh) -> "KeyAnimation | None":
        """The animation of the mesh's keys; None if there is none."""
        keys = mesh.shape_keys
        if keys is None or keys.animation_data is None:
            return None
        return cls(session_key(mesh.copy()))

    def give(self, target: Object, last: bool = True) -> list[str]:
        """Attaches the animation to the keys; returns what is lost. `last`: no call follows."""
        spare, notes = self._mesh(), []
        new = target.data.shape_keys
        if new is None or spare is None:  # undo may have removed the copy
            notes.append("The animation of the surface's shape keys is dropped.")
        else:
            old = spare.shape_keys
            its = old.animation_data
            if its.action is not None:
                _act(its, new.animation_data_create())
            driven = (
                {d.data_path for d in new.animation_data.drivers} if new.animation_data else set()
            )
            copy_drivers(old, new, leave_out=driven)
            if len(its.nla_tracks):
                notes.append("The NLA tracks of the surface's shape keys are dropped.")
        if last:
            self.drop()
        return notes

    def drop(self) -> None:
        """Frees the copy without attaching the animation."""
        spare = self._mesh()
        if spare is not None:
            bpy.data.meshes.remove(spare)

    def _mesh(self) -> Any:
        return next((m for m in bpy.data.meshes if session_key(m) == self.spare), None)


def _act(old: Any, new: Any) -> None:
    new.action = old.action
    if getattr(old, "action_slot", None) is not None:  # Blender 4.4 and later
        new.action_slot = old.action_slot
