# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes a mesh with elements by BMesh only, since extending its arrays crashes Blender 5.2."""

from collections.abc import Iterator
from contextlib import contextmanager

import bmesh

from ..blender import Object


@contextmanager
def edited(target: Object) -> Iterator[bmesh.types.BMesh]:
    """Lets the mesh of `target` be changed in either mode; Blender makes normals when needed."""
    mesh = target.data
    if target.mode == "EDIT":
        yield bmesh.from_edit_mesh(mesh)
        bmesh.update_edit_mesh(mesh)
        return
    bm = bmesh.new()
    try:
        bm.from_mesh(mesh, face_normals=False, vertex_normals=False)
        yield bm
        bm.to_mesh(mesh)
        mesh.update()
    finally:
        bm.free()


def select_nothing(target: Object) -> None:
    """In Object Mode, deselects everything; the mesh may have no selection attributes."""
    attributes = target.data.attributes
    for name in (".select_vert", ".select_edge", ".select_poly"):
        if name in attributes:
            attributes.remove(attributes[name])
