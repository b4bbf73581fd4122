# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh that has elements is changed by BMesh alone: to lengthen its arrays crashes Blender 5.2."""

from collections.abc import Iterator
from contextlib import contextmanager

import bmesh

from ..blender import Object


@contextmanager
def edited(target: Object) -> Iterator[bmesh.types.BMesh]:
    """The mesh of `target`, to be changed inside of the `with`, in Edit Mode and Object Mode. In Object Mode
    its normals are not computed: they take longer than all else, and go with it.
    """
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
    """In Object Mode: what is selected is a list that the mesh may do without."""
    attributes = target.data.attributes
    for name in (".select_vert", ".select_edge", ".select_poly"):
        if name in attributes:
            attributes.remove(attributes[name])
