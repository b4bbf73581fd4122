# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the faces that fill a hole, by BMesh, with the rim's data blended over the filling."""

from collections.abc import Callable, Collection, Iterator
from typing import Any

import bmesh
import numpy as np

from ..transfer.filling import Patch, spread
from .layers import OWN_VERTICES_ONLY

Read = Callable[[Any], list[float]]
Write = Callable[[Any, list[float]], None]
# values of all vertices of a filling, and a function that writes one
Spread = list[tuple[Write, np.ndarray]]
# kinds of layers that can be interpolated
_NUMBERS = ("float", "float_vector", "color", "float_color")


def write_hole(bm: Any, patch: Patch, verts: list[Any]) -> list[Any]:
    """Makes the faces of `patch` between its `verts`, r of the rim and k new ones; returns them.

    Numbers are interpolated from the rim. Other data are those of the nearest vertex of the rim, and of
    a face there.
    """
    rim = verts[: len(patch.rim)]
    beside = [next(iter(v.link_loops), None) for v in rim]
    of_vertices = _spread_vertices(bm, rim, patch)
    of_corners = _spread_corners(bm, rim, patch)
    nearest = patch.nearest.tolist()
    for write, rows in of_vertices:
        for vertex, values in zip(verts[len(rim) :], rows[len(rim) :].tolist(), strict=True):
            write(vertex, values)
    found = []
    for corners in (corners for faces in patch.faces for corners in faces.tolist()):
        model = beside[nearest[corners[0]]]
        face = bm.faces.new([verts[v] for v in corners], *([model.face] if model else []))
        for corner, v in zip(face.loops, corners, strict=True):
            if beside[nearest[v]] is not None:
                corner.copy_from(beside[nearest[v]])
        # again, since copying to a corner invalidates references to it
        for corner, v in zip(face.loops, corners, strict=True):
            for write, rows in of_corners:
                write(corner, rows[v].tolist())
        found.append(face)
    return found


def with_new(bm: Any, patch: Patch, rim: list[Any], places: np.ndarray) -> list[Any]:
    """The `rim` (r vertices) of a patch and its new vertices, made at `places` (k, 3) with the data of the
    nearest vertex of the rim.
    """
    keys = bm.verts.layers.shape.values()
    verts = list(rim)
    for place, like in zip(places.tolist(), patch.nearest[len(rim) :].tolist(), strict=True):
        made = bm.verts.new(place, rim[like])
        made.co = place
        for key in keys:
            made[key] = made.co
        verts.append(made)
    return verts


def cut_sides(bm: Any, sides: list[list[Any]]) -> None:
    """Cuts border edges, each given with its ends and the vertices on it, at these vertices and joins
    them. Triangles become triangles, and their corners get data interpolated along the edge.
    """
    places: dict[Any, Any] = {}
    for side in sides:
        edge = bm.edges.get([side[0], side[-1]])
        (face,) = edge.link_faces
        (tip,) = set(face.verts) - set(edge.verts) if len(face.verts) == 3 else (None,)
        for vertex in side[1:-1]:
            begin = edge.other_vert(side[-1])
            way = side[-1].co - begin.co
            share = (vertex.co - begin.co).dot(way) / way.length_squared
            _, fresh = bmesh.utils.edge_split(edge, begin, share)
            places[fresh] = vertex
            if tip is not None:
                (face,) = fresh.link_faces
                bmesh.utils.face_split(face, tip, fresh)
            edge = bm.edges.get([fresh, side[-1]])
    bmesh.ops.weld_verts(bm, targetmap=places)


def _spread_vertices(bm: Any, rim: list[Any], patch: Patch) -> Spread:
    found: Spread = []
    for read, write in _layers(bm.verts.layers, OWN_VERTICES_ONLY):
        found.append((write, spread(patch.points, np.array([read(v) for v in rim]))))
    for deform in bm.verts.layers.deform.values():
        groups = sorted({g for v in rim for g, _ in v[deform].items()})
        if groups:
            shares = np.array([[v[deform].get(g, 0.0) for g in groups] for v in rim])
            found.append((_weights(deform, groups), spread(patch.points, shares)))
    return found


def _weights(deform: Any, groups: list[int]) -> Write:
    def write(vertex: Any, row: list[float]) -> None:
        held = vertex[deform]
        held.clear()
        for group, share in zip(groups, row, strict=True):
            if share > 0.0:
                held[group] = share

    return write


def _spread_corners(bm: Any, rim: list[Any], patch: Patch) -> Spread:
    """Values of the layers that are continuous around the whole rim; across a seam there is no mean."""
    found: Spread = []
    for read, write in _layers(bm.loops.layers):
        values = [[read(corner) for corner in v.link_loops] for v in rim]
        if all(row and all(value == row[0] for value in row) for row in values):
            found.append((write, spread(patch.points, np.array([row[0] for row in values]))))
    return found


def _layers(layers: Any, zero: Collection[str] = ()) -> Iterator[tuple[Read, Write]]:
    """Readers and writers of an element, for each layer to interpolate; `zero`: read as 0."""
    for kind in _NUMBERS:
        for name, layer in getattr(layers, kind).items():
            if name in zero:
                yield (lambda _: [0.0]), _numbers(layer, True)[1]
                continue
            yield _numbers(layer, kind == "float")
    for layer in getattr(layers, "uv", {}).values():
        yield _uv(layer)


def _numbers(layer: Any, single: bool) -> tuple[Read, Write]:
    def write(element: Any, row: list[float]) -> None:
        element[layer] = row[0] if single else row

    return lambda element: [element[layer]] if single else list(element[layer]), write


def _uv(layer: Any) -> tuple[Read, Write]:
    def write(element: Any, row: list[float]) -> None:
        element[layer].uv = row

    return lambda element: list(element[layer].uv), write
