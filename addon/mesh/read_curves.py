# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads curve objects, and edges without faces, as curves in the world."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, cast

import numpy as np

from ..blender import Object, column
from ..curves.chains import chains
from ..curves.cubics import Curve, from_bezier, from_nurbs, through
from .read import read_mesh
from .world_shape import transformed

_LOOKED_AT = 100_000  # corners; a few milliseconds


def has_curves(source: Object) -> bool:
    """Whether there are curves to read. Fast enough for panels."""
    if source.type == "CURVE":
        return bool(cast(Any, source.data).splines)
    return source.type == "MESH" and _has_wires(source.data)


def _has_wires(mesh: Any) -> bool:
    """Whether an edge has no face; large meshes are not searched while panels are drawn."""
    if not len(mesh.polygons) or len(mesh.loops) > _LOOKED_AT:
        return bool(len(mesh.edges)) and not len(mesh.polygons)
    return len(np.unique(column(mesh.loops, "edge_index", np.int32))) < len(mesh.edges)


def read_curves(source: Object) -> list[Curve]:
    """All curves of `source`, with present edits, in the world's coordinates; marked ones are sharp."""
    found = list(_splines(source) if source.type == "CURVE" else _wires(source))
    sharp = source.discrete_fairing_curves.sharp
    matrix = np.array(source.matrix_world)
    return [
        replace(
            curve,
            name=source.name if len(found) == 1 else f"{source.name}, {curve.name}",
            pieces=transformed(curve.pieces, matrix),
            sharp=curve.sharp or sharp,
        )
        for curve in found
    ]


def _splines(source: Object) -> Iterator[Curve]:
    data: Any = source.data
    for number, spline in enumerate(data.splines, 1):
        closed, title = bool(spline.use_cyclic_u), f"spline {number}"
        if spline.type == "BEZIER":
            points, left, right = (
                column(spline.bezier_points, name, width=3).astype(float)
                for name in ("co", "handle_left", "handle_right")
            )
            yield Curve(title, from_bezier(points, left, right, closed), closed)
            continue
        points = column(spline.points, "co", width=4).astype(float)
        if spline.type == "NURBS":
            pieces = from_nurbs(
                points, spline.order_u, closed, spline.use_endpoint_u, spline.use_bezier_u
            )
        else:
            pieces = through(points[:, :3], closed)
        yield Curve(title, pieces, closed)


def _wires(source: Object) -> Iterator[Curve]:
    """Chains of edges without faces, from one end or branching point to the next."""
    if source.mode == "EDIT":
        source.update_from_editmode()
    arrays = read_mesh(source.data)
    wires = np.flatnonzero(arrays.edge_uses == 0)
    marks = np.zeros(len(arrays.edges), bool)
    if arrays.sharp_edge is not None:
        marks |= arrays.sharp_edge
    if arrays.edge_crease is not None:
        marks |= arrays.edge_crease > 0
    for number, (chain, sharp) in enumerate(chains(arrays.edges[wires], marks[wires]), 1):
        closed = chain[0] == chain[-1]
        points = arrays.positions[chain[:-1] if closed else chain]
        yield Curve(f"edges {number}", through(points, closed), closed, sharp)
