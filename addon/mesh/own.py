# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of a faired surface that stay when it is recomputed.

Its own data are the vertex groups, attributes, UV maps, colours, marks and shape keys that do not have
a name from the source. Materials, custom properties and modifiers stay anyway.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..blender import Object
from ..core import ControlArrays
from ..words import listed
from .layers import Names, SurfaceData, read_data, write_data
from .read import read_mesh
from .samples import Samples
from .shape_keys import KeyAnimation, ShapeKey, ShapeKeys, add_shape_key

# from its creases and settings, always replaced
_MADE_ANEW = {"sharp_edge", "sharp_face"}
_OURS = ("fair_", "Fairing ")  # prefixes of the add-on's attributes


def carried_names(data: SurfaceData, keys: ShapeKeys | None) -> Names:
    """The names of data that a surface has from its source."""
    return {
        "attributes": [attribute.name for attribute in data.attributes],
        "groups": [group.name for group in data.groups],
        "marks": [mark.name for mark in data.marks],
        "keys": [key.name for key in keys.keys] if keys else [],
    }


@dataclass(frozen=True)
class OwnData:
    """The surface's own data, read before its mesh is replaced."""

    mesh: ControlArrays
    data: SurfaceData
    # key, its relative key, (n, 3) difference from that
    keys: list[tuple[ShapeKey, str, np.ndarray]]
    animation: KeyAnimation | None

    def write_keys(self, target: Object, last: bool = True) -> list[str]:
        """Gives `target` the shape keys; returns what is lost. `last`: no other call follows."""
        samples = Samples(self.mesh, read_mesh(target.data)) if self.keys else None
        for key, relative, away in self.keys:
            assert samples is not None
            add_shape_key(target, key, relative, samples.values(away, "POINT", True))
        return self.animation.give(target, last) if self.animation else []

    def drop(self) -> None:
        if self.animation:
            self.animation.drop()


def read_own(target: Object, *carried: Names) -> OwnData | None:
    """Data of the surface in Object Mode that are not `carried` from its source; or None."""
    mesh = target.data
    taken = {
        kind: {name for names in carried for name in names.get(kind, [])}
        for kind in ("attributes", "groups", "marks", "keys")
    }
    taken["attributes"] |= _MADE_ANEW | {
        a.name for a in mesh.attributes if a.name.startswith(_OURS)
    }
    data = read_data(target, mesh, taken=taken)
    keys, animation = _own_keys(data.shape_keys, taken["keys"]), KeyAnimation.of(mesh)
    if not (data.attributes or data.marks or data.groups or keys or animation):
        return None
    return OwnData(read_mesh(mesh), data, keys, animation)


def write_own(target: Object, own: OwnData, in_handler: bool = False) -> list[str]:
    """Gives `target` its own data, no keys in a handler; returns what is lost, in sentences."""
    samples = Samples(own.mesh, read_mesh(target.data))
    lost = write_data(target, own.data, samples, operators=not in_handler)
    notes = [f"The attribute '{name}' of the surface is dropped." for name in own.data.unknown]
    notes += [] if in_handler else own.write_keys(target)
    if lost:
        notes.append(f"{_listed(lost)} dropped: the surface has other edges now.")
    parts: tuple[Any, ...] = (
        *own.data.attributes,
        *own.data.groups,
        *(key for key, *_ in own.keys),
    )
    moved = [part.name for part in parts if part.name not in lost]
    if moved and not samples.keeps_ids:
        notes.append(f"{_listed(moved)} carried over from the nearest places of the old surface.")
    return notes


def _own_keys(keys: ShapeKeys | None, taken: set[str]) -> list[tuple[ShapeKey, str, np.ndarray]]:
    if keys is None:
        return []
    return [
        (
            key,
            keys.keys[key.relative_key].name,
            keys.positions[place] - keys.positions[key.relative_key],
        )
        for place, key in enumerate(keys.keys)
        if place and key.name not in taken
    ]


def _listed(names: list[str]) -> str:
    """For example `'A' and 'B' are`."""
    quoted = listed([f"'{name}'" for name in names])
    return f"{quoted} are" if len(names) > 1 else f"{quoted} is"
