# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that are meant flat: a Boolean attribute on faces."""

from collections.abc import Iterable

import bmesh
import numpy as np

from ..blender import Mesh, Object
from .layers import fill_layer, find_layer, layer_values, make_layer
from .mesh_changes import shown

FLAT = "fair_flat"


def mark_selected(mesh: Mesh, flat: bool) -> int:
    """Marks the selected faces of `mesh`, which is in Edit Mode, or unmarks them; returns how many there are."""
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.faces.layers.bool.get(FLAT)
    if layer is None and flat and any(face.select for face in edit.faces):
        layer = edit.faces.layers.bool.new(FLAT)
    chosen = [face for face in edit.faces if face.select]
    if layer is not None:
        for face in chosen:
            face[layer] = flat
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(chosen)


def mark(mesh: Mesh, faces: np.ndarray) -> None:
    """Marks the `faces` (m,) bool of `mesh`, which is in Object Mode, beside those that are marked."""
    if faces.any():
        layer = make_layer(mesh, FLAT, "BOOLEAN", "FACE")
        fill_layer(layer, faces | layer_values(layer))
        mesh.update()


def clear(mesh: Mesh) -> int:
    """Unmarks all faces of `mesh`, which is in Object Mode; returns how many were marked."""
    layer = find_layer(mesh, FLAT, "BOOLEAN", "FACE")
    if layer is None:
        return 0
    found = int(layer_values(layer).sum())
    mesh.attributes.remove(layer)
    mesh.update()
    return found


def count(sources: Iterable[Object]) -> int:
    """How many faces are marked."""
    return sum(shown(source.data, FLAT, _count, 0) for source in sources)


def _count(mesh: Mesh) -> int:
    if mesh.is_editmode:  # then the mesh lists no values
        edit = bmesh.from_edit_mesh(mesh)
        marked = edit.faces.layers.bool.get(FLAT)
        return 0 if marked is None else sum(face[marked] for face in edit.faces)
    layer = find_layer(mesh, FLAT, "BOOLEAN", "FACE")
    return 0 if layer is None else int(layer_values(layer).sum())
