# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces that fill holes, appended to a mesh in Object Mode: no element that was there is made anew,
so that a large mesh costs a few copies of its arrays.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..blender import Mesh, Object
from ..core import ControlArrays
from ..transfer.filling import Patch
from ..transfer.harmonic import spread
from .layers import (
    FACE_MARKS,
    OWN_VERTICES_ONLY,
    STORAGE,
    Attribute,
    fill_layer,
    find_layer,
    make_layer,
    read_attributes,
    read_marks,
)


def can_append(target: Object) -> bool:
    """Whether Blender can lengthen all that the mesh of `target` has: not its shape keys, sizes of
    skin and displacements.
    """
    mesh = target.data
    levels = any(modifier.type == "MULTIRES" for modifier in target.modifiers)
    return mesh.shape_keys is None and not levels and not len(mesh.skin_vertices)


def append_holes(
    target: Object, arrays: ControlArrays, patches: Sequence[Patch], places: np.ndarray
) -> None:
    """To the mesh of `target`, which is `arrays`: makes the faces of `patches`, whose new vertices follow on those of the mesh, at `places`
    (k, 3), in the object's coordinates. The new faces are selected, and nothing else.

    What can be mixed is spread from the rim. All else is that of the nearest vertex of the rim, and
    of a face there.
    """
    mesh = target.data
    rims = _Rims.of(arrays, patches)
    made = [_continued(attribute, rims) for attribute in read_attributes(mesh)[0]]
    marks = {
        name: np.concatenate([values, *(values[rim.faces] for rim in rims.all)])
        for name, values in read_marks(mesh.polygons, FACE_MARKS).items()
    }
    weights = [_weights(mesh, rim.patch) for rim in rims.all]
    _append(mesh, rims, places)
    for attribute in made:
        layer = find_layer(mesh, attribute.name, attribute.data_type, attribute.domain)
        fill_layer(layer, attribute.values)
    for name, values in marks.items():
        mesh.polygons.foreach_set(name, values)
    for of_patch in weights:
        _write_weights(target, of_patch)
    mesh.update(calc_edges_loose=True)


@dataclass(frozen=True)
class _Rim:
    """A patch, and what is beside its vertices in the mesh."""

    patch: Patch
    corners: np.ndarray  # (r,) a corner at each vertex of the rim
    all_corners: list[np.ndarray]  # (r,) all of them
    faces: np.ndarray  # (t,) the face that each face of the patch takes after


@dataclass(frozen=True)
class _Rims:
    all: list[_Rim]
    corners: np.ndarray  # (c,) ids, of one new face after another
    sizes: np.ndarray  # (t,) corners of each
    edges: np.ndarray  # (e, 2) those that the mesh does not have
    corner_edges: np.ndarray  # (c,)

    @classmethod
    def of(cls, arrays: ControlArrays, patches: Sequence[Patch]) -> "_Rims":
        corners = arrays.corners
        at_rim = np.zeros(len(arrays.positions), bool)
        for patch in patches:
            at_rim[patch.rim] = True
        near = np.flatnonzero(at_rim[corners])
        near = near[np.argsort(corners[near], kind="stable")]
        rims = [_beside(patch, near, corners[near], arrays.offsets) for patch in patches]
        ids = [np.concatenate([patch.rim, patch.fresh])[patch.faces] for patch in patches]
        of_all = np.concatenate([faces.ravel() for faces in ids]).astype(np.int32)
        ends = np.concatenate([np.roll(faces, -1, axis=1).ravel() for faces in ids])
        sizes = np.concatenate([np.full(*faces.shape) for faces in ids])
        return cls(rims, of_all, sizes, *_edges(np.stack([of_all, ends], 1), arrays.edges, at_rim))


def _beside(patch: Patch, near: np.ndarray, vertices: np.ndarray, offsets: np.ndarray) -> _Rim:
    """`near`: corners by the id of their vertex, which is in `vertices`."""
    begin, end = (np.searchsorted(vertices, patch.rim, side) for side in ("left", "right"))
    all_corners = [near[a:b] for a, b in zip(begin.tolist(), end.tolist(), strict=True)]
    corners = near[begin]
    faces = np.searchsorted(offsets, corners, side="right") - 1
    return _Rim(patch, corners, all_corners, faces[patch.nearest[patch.faces[:, 0]]])


def _edges(
    sides: np.ndarray, edges: np.ndarray, at_rim: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Of `sides` (c, 2), one from each corner: the edges that are missing, and the edge of each."""
    sides = np.sort(sides, axis=1)
    factor = int(sides.max()) + 1

    def keys(pairs: np.ndarray) -> np.ndarray:
        return pairs[:, 0].astype(np.int64) * factor + pairs[:, 1]

    known = np.flatnonzero(at_rim[edges].all(axis=1))
    wanted, of_corner = np.unique(keys(sides), return_inverse=True)
    there = keys(np.sort(edges[known], axis=1))
    order = np.argsort(there)
    place = np.searchsorted(there[order], wanted).clip(max=len(there) - 1)
    found = there[order][place] == wanted
    ids = np.where(found, known[order][place], len(edges) + np.cumsum(~found) - 1)
    fresh = wanted[~found]
    pairs = np.stack([fresh // factor, fresh % factor], axis=1).astype(np.int32)
    return pairs, ids[of_corner.ravel()].astype(np.int32)


def _continued(attribute: Attribute, rims: _Rims) -> Attribute:
    """With the values of the new elements."""
    values = attribute.values
    if attribute.domain == "EDGE":
        more = [np.zeros((len(rims.edges), *values.shape[1:]), values.dtype)]
    else:
        more = [_more(attribute, rim) for rim in rims.all]
    return Attribute(
        attribute.name,
        attribute.data_type,
        attribute.domain,
        np.concatenate([values, *more]).astype(values.dtype, copy=False),
    )


def _more(attribute: Attribute, rim: _Rim) -> np.ndarray:
    values, patch = attribute.values, rim.patch
    mixable = STORAGE[attribute.data_type].mixable
    if attribute.domain == "FACE":
        return values[rim.faces]
    if attribute.domain == "POINT":
        if attribute.name in OWN_VERTICES_ONLY:
            return np.zeros((len(patch.fresh), *values.shape[1:]), values.dtype)
        at_rim = values[patch.rim]
        whole = _spread(patch, at_rim) if mixable else at_rim[patch.nearest]
        return whole[len(patch.rim) :]
    known = values[rim.corners]
    # across a seam there is no mean
    one = mixable and all(
        (values[c] == v).all() for c, v in zip(rim.all_corners, known, strict=True)
    )
    whole = _spread(patch, known) if one else known[patch.nearest]
    return whole[patch.faces.ravel()]


def _spread(patch: Patch, known: np.ndarray) -> np.ndarray:
    rows = known.reshape(len(known), -1).astype(float)
    found = spread(patch.points, patch.triangles, rows)
    return found.reshape(-1, *known.shape[1:])


def _weights(mesh: Mesh, patch: Patch) -> list[tuple[int, np.ndarray, np.ndarray]]:
    """Of each vertex group that the rim has: its number, ids of new vertices, their weights."""
    held = [{g.group: g.weight for g in mesh.vertices[v].groups} for v in patch.rim.tolist()]
    groups = sorted(set().union(*held))
    if not groups:
        return []
    found = _spread(patch, np.array([[h.get(g, 0.0) for g in groups] for h in held]))
    return [
        (group, patch.fresh[of_group > 0.0], of_group[of_group > 0.0])
        for group, of_group in zip(groups, found[len(patch.rim) :].T, strict=True)
    ]


def _write_weights(target: Object, weights: Sequence[tuple[int, np.ndarray, np.ndarray]]) -> None:
    for group, vertices, of_group in weights:
        owner = target.vertex_groups[group]
        for vertex, weight in zip(vertices.tolist(), of_group.tolist(), strict=True):
            owner.add([vertex], weight, "REPLACE")


def _append(mesh: Mesh, rims: _Rims, places: np.ndarray) -> None:
    """Shape and topology."""
    vertices, edges = len(mesh.vertices), len(mesh.edges)
    corners, faces = len(mesh.loops), len(mesh.polygons)
    mesh.vertices.add(len(places))
    mesh.edges.add(len(rims.edges))
    mesh.loops.add(len(rims.corners))
    mesh.polygons.add(len(rims.sizes))
    starts = corners + np.cumsum(rims.sizes) - rims.sizes
    for face, start in enumerate(starts.tolist(), start=faces):
        mesh.polygons[face].loop_start = start
    _end(mesh, "position", vertices, places.astype(np.float32))
    _end(mesh, ".edge_verts", edges, rims.edges)
    _end(mesh, ".corner_vert", corners, rims.corners)
    _end(mesh, ".corner_edge", corners, rims.corner_edges)
    _select_only_new(mesh, rims, faces)


def _end(mesh: Mesh, name: str, first: int, values: np.ndarray) -> None:
    """Writes the last elements of a layer, which begin with the `first`."""
    layer = mesh.attributes[name]
    field, width = STORAGE[layer.data_type].field, STORAGE[layer.data_type].width
    whole = np.empty(len(layer.data) * width, values.dtype)
    layer.data.foreach_get(field, whole)
    whole[first * width :] = values.ravel()
    layer.data.foreach_set(field, whole)


def _select_only_new(mesh: Mesh, rims: _Rims, faces: int) -> None:
    for name, domain, size, new in (
        (".select_vert", "POINT", len(mesh.vertices), rims.corners),
        (".select_edge", "EDGE", len(mesh.edges), rims.corner_edges),
        (".select_poly", "FACE", len(mesh.polygons), np.arange(faces, len(mesh.polygons))),
    ):
        chosen = np.zeros(size, bool)
        chosen[new] = True
        fill_layer(make_layer(mesh, name, "BOOLEAN", domain), chosen)
