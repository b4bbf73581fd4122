# SPDX-License-Identifier: GPL-3.0-or-later
"""Boundaries of single border edges: an integer attribute on edges, numbered as in
choices.EDGE_BOUNDARIES. 0, or no attribute: the surface's setting applies.
"""

from collections.abc import Iterable

import bmesh
import numpy as np

from ..blender import Mesh, Object, column
from ..choices import EDGE_BOUNDARIES
from .layers import find_layer, layer_values
from .mesh_changes import shown

BOUNDARY = "fair_boundary"

_NUMBERS = {key: number for key, _, _, number in EDGE_BOUNDARIES}


def mark_selected(mesh: Mesh, boundary: str) -> int:
    """Gives selected border edges, in Edit Mode, one of EDGE_BOUNDARIES; returns their number."""
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.edges.layers.int.get(BOUNDARY)
    chosen = _selected(edit)
    if layer is None and _NUMBERS[boundary] and chosen:
        layer = edit.edges.layers.int.new(BOUNDARY)
        chosen = _selected(edit)  # a new layer invalidates references to edges
    if layer is not None:
        for edge in chosen:
            edge[layer] = _NUMBERS[boundary]
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)


def _selected(edit: bmesh.types.BMesh) -> list[bmesh.types.BMEdge]:
    return [edge for edge in edit.edges if edge.select and edge.is_boundary]


def select_marked(mesh: Mesh, boundary: str) -> int:
    """Adds the border edges with this boundary to the selection; returns their number."""
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.edges.layers.int.get(BOUNDARY)
    if layer is None:
        return 0
    number = _NUMBERS[boundary]
    chosen = [e for e in edit.edges if e[layer] == number and e.is_boundary and not e.hide]
    for edge in chosen:
        edge.select = True
    edit.select_flush_mode()
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)


def summary(sources: Iterable[Object]) -> str:
    """For example `Edges: 8 Straight, 4 Free`; empty if no border edge has its own boundary."""
    none = np.zeros(len(_NUMBERS), int)
    total = sum((shown(source.data, BOUNDARY, _counts, none) for source in sources), none)
    parts = [
        f"{total[number]} {name}"
        for _, name, _, number in EDGE_BOUNDARIES
        if number and total[number]
    ]
    return "Edges: " + ", ".join(parts) if parts else ""


def _counts(mesh: Mesh) -> np.ndarray:
    marks = _border_marks(mesh)
    return np.bincount(marks[(marks >= 0) & (marks < len(_NUMBERS))], minlength=len(_NUMBERS))


def _border_marks(mesh: Mesh) -> np.ndarray:
    if mesh.is_editmode:  # the mesh lists no values in Edit Mode
        edit = bmesh.from_edit_mesh(mesh)
        layer = edit.edges.layers.int.get(BOUNDARY)
        found = [] if layer is None else [e[layer] for e in edit.edges if e.is_boundary]
        return np.array(found, np.int32)
    layer = find_layer(mesh, BOUNDARY, "INT", "EDGE")
    if layer is None:
        return np.empty(0, np.int32)
    uses = np.bincount(column(mesh.loops, "edge_index", np.int32), minlength=len(mesh.edges))
    return layer_values(layer)[uses == 1]
