# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces to keep flat: a Boolean attribute on faces."""

from collections.abc import Iterable
from typing import Any

import bmesh
import numpy as np

from ..blender import Mesh, Object, column
from .layers import fill_layer, find_layer, layer_values, make_layer
from .mesh_changes import shown

FLAT = "fair_flat"


def mark_selected(mesh: Mesh, flat: bool) -> int:
    """Marks selected faces in Object Mode, or unmarks them; returns their number."""
    chosen = column(mesh.polygons, "select", bool)
    if flat:
        mark(mesh, chosen)
    elif (layer := find_layer(mesh, FLAT, "BOOLEAN", "FACE")) is not None:
        fill_layer(layer, layer_values(layer) & ~chosen)
    return int(chosen.sum())


def mark(mesh: Mesh, faces: np.ndarray) -> None:
    """Marks the `faces` (m,) bool of `mesh`, which is in Object Mode, in addition to marked ones."""
    if faces.any():
        layer = make_layer(mesh, FLAT, "BOOLEAN", "FACE")
        fill_layer(layer, faces | layer_values(layer))
        mesh.update()


def clear(mesh: Mesh) -> int:
    """Unmarks all faces of `mesh`, which is in Object Mode; returns the number of marked ones."""
    layer = find_layer(mesh, FLAT, "BOOLEAN", "FACE")
    if layer is None:
        return 0
    found = int(layer_values(layer).sum())
    mesh.attributes.remove(layer)
    mesh.update()
    return found


def count(sources: Iterable[Object]) -> int:
    """Number of marked faces; 0 in Edit Mode where Blender does not show the attribute."""
    return sum(shown(source.data, FLAT, _count, 0) for source in sources)


def _count(mesh: Mesh) -> int:
    if mesh.is_editmode:  # the mesh lists no values in Edit Mode
        edit = bmesh.from_edit_mesh(mesh)
        marked = None if (flags := _flags(edit)) is None else flags.get(FLAT)
        return 0 if marked is None else sum(face[marked] for face in edit.faces)
    layer = find_layer(mesh, FLAT, "BOOLEAN", "FACE")
    return 0 if layer is None else int(layer_values(layer).sum())


def _flags(edit: bmesh.types.BMesh) -> Any:
    """The Boolean layers of faces; None in Blender 4.3 and 4.4, which do not provide them."""
    return getattr(edit.faces.layers, "bool", None)
