# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of a faired surface that stay when it is recomputed.

Its own data are the vertex groups, attributes, UV maps, colours, marks and shape keys that do not have
a name from the source. Materials, custom properties and modifiers stay anyway.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from mathutils.bvhtree import BVHTree

from ..blender import Object
from ..core import ControlArrays, are_equal, measured
from ..triangles import fans
from ..words import listed
from .layers import STORAGE, Attribute, Names, SurfaceData, read_data, write_data
from .read import read_mesh
from .shape_keys import KeyAnimation, ShapeKey, ShapeKeys, add_shape_key

# relative offset to a face's centre, which tells on which side of a seam a corner is
_INWARD = 0.05


class Samples:
    """From the elements of `old` to those of `new`, two meshes of nearly the same shape."""

    def __init__(self, old: ControlArrays, new: ControlArrays) -> None:
        self.keeps_ids = len(old.positions) == len(new.positions) and are_equal(
            (old.corners, old.offsets, old.edges), (new.corners, new.offsets, new.edges)
        )
        self._old, self._new = old, new
        self._known: dict[str, tuple[np.ndarray, np.ndarray]] = {}  # by domain

    def of(self, attribute: Attribute) -> np.ndarray | None:
        if attribute.domain == "EDGE" and not self.keeps_ids:
            return None
        return self.values(attribute.values, attribute.domain, STORAGE[attribute.data_type].mixable)

    def values(self, values: np.ndarray, domain: str, mixable: bool) -> np.ndarray:
        """(size, …) values of old elements of `domain` → of new ones; interpolated if `mixable`."""
        if self.keeps_ids:
            return values
        if not len(self._triangles[0]):
            new = self._new
            of = {"POINT": new.positions, "CORNER": new.corners, "FACE": new.face_sizes}[domain]
            return np.zeros((len(of), *values.shape[1:]), values.dtype)
        if domain not in self._known:
            self._known[domain] = self._find(domain)
        ids, weights = self._known[domain]
        if domain == "FACE":
            return values[ids]
        if mixable:
            return np.einsum("ij,ij...->i...", weights, values[ids].astype(np.float64))
        return values[np.take_along_axis(ids, weights.argmax(axis=1)[:, None], axis=1)[:, 0]]

    def _find(self, domain: str) -> tuple[np.ndarray, np.ndarray]:
        """Old elements with weights (k, 3) for each new one; for faces only their ids (k,)."""
        new, (triangles, faces) = self._new, self._triangles
        centres = measured(new).face_centres
        if domain == "FACE":
            return faces[self._nearest(centres)], np.empty(0)
        places = new.positions
        sought = places
        if domain == "CORNER":
            places = new.positions[new.corners]
            sought = places + _INWARD * (centres[new.face_of] - places)
        found = triangles[self._nearest(sought)]
        weights = _barycentric(self._old.positions[self._old.corners[found]], places)
        return (found if domain == "CORNER" else self._old.corners[found]), weights

    @cached_property
    def _triangles(self) -> tuple[np.ndarray, np.ndarray]:
        """(t, 3) corners of the old mesh as triangles, fans of its faces, and (t,) their faces."""
        return fans(self._old.offsets[:-1], np.diff(self._old.offsets))

    @cached_property
    def _tree(self) -> Any:
        triangles = self._old.corners[self._triangles[0]].tolist()
        return BVHTree.FromPolygons(self._old.positions.tolist(), triangles, all_triangles=True)

    def _nearest(self, places: np.ndarray) -> np.ndarray:
        """(k,) the nearest old triangle for each place."""
        find = self._tree.find_nearest
        return np.array([find(place)[2] or 0 for place in places.tolist()], np.int64)


def _barycentric(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(k, 3) weights of the corners (k, 3, 3) at the projections of the places to their planes."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = places - corners[:, 0]
    aa, ab, bb = ((x * y).sum(axis=1) for x, y in ((a, a), (a, b), (b, b)))
    pa, pb = (p * a).sum(axis=1), (p * b).sum(axis=1)
    area = aa * bb - ab * ab
    safe = np.where(area > 0.0, area, 1.0)
    u = np.where(area > 0.0, (bb * pa - ab * pb) / safe, 0.0)
    v = np.where(area > 0.0, (aa * pb - ab * pa) / safe, 0.0)
    return np.stack([1.0 - u - v, u, v], axis=1)


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
