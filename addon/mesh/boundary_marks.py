# SPDX-License-Identifier: GPL-3.0-or-later
"""Border edges with a boundary of their own: an integer attribute on edges, numbered as
choices.EDGE_BOUNDARIES is. 0, and no attribute: as the surface's setting says.
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
    """Gives the selected border edges of `mesh`, which is in Edit Mode, a boundary of
    EDGE_BOUNDARIES; returns how many there are.
    """
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.edges.layers.int.get(BOUNDARY)
    chosen = _selected(edit)
    if layer is None and _NUMBERS[boundary] and chosen:
        layer = edit.edges.layers.int.new(BOUNDARY)
        chosen = _selected(edit)  # a new layer makes edges from before invalid
    if layer is not None:
        for edge in chosen:
            edge[layer] = _NUMBERS[boundary]
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)


def _selected(edit: bmesh.types.BMesh) -> list[bmesh.types.BMEdge]:
    """Its border edges that are selected."""
    return [edge for edge in edit.edges if edge.select and edge.is_boundary]


def select_marked(mesh: Mesh, boundary: str) -> int:
    """Adds the border edges of `mesh`, which is in Edit Mode, that are marked so to the selection;
    returns how many there are.
    """
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
    """`Edges: 8 Straight, 4 Free`; empty where no border edge has a boundary of its own."""
    none = np.zeros(len(_NUMBERS), int)
    total = sum((shown(source.data, BOUNDARY, _counts, none) for source in sources), none)
    parts = [
        f"{total[number]} {name}"
        for _, name, _, number in EDGE_BOUNDARIES
        if number and total[number]
    ]
    return "Edges: " + ", ".join(parts) if parts else ""


def _counts(mesh: Mesh) -> np.ndarray:
    """How many border edges have each number."""
    marks = _border_marks(mesh)
    return np.bincount(marks[(marks >= 0) & (marks < len(_NUMBERS))], minlength=len(_NUMBERS))


def _border_marks(mesh: Mesh) -> np.ndarray:
    if mesh.is_editmode:  # then the mesh lists no values
        edit = bmesh.from_edit_mesh(mesh)
        layer = edit.edges.layers.int.get(BOUNDARY)
        found = [] if layer is None else [e[layer] for e in edit.edges if e.is_boundary]
        return np.array(found, np.int32)
    layer = find_layer(mesh, BOUNDARY, "INT", "EDGE")
    if layer is None:
        return np.empty(0, np.int32)
    uses = np.bincount(column(mesh.loops, "edge_index", np.int32), minlength=len(mesh.edges))
    return layer_values(layer)[uses == 1]
