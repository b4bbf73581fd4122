# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls with holes."""

import bmesh
import numpy as np
from scenes import activate, add_ball, bmesh_of, faces_at_edges, positions


def ball(name="Ball"):
    """A unit sphere of 1,280 triangles."""
    return add_ball(name, 4)


def without(target, chosen):
    """Erases the faces for which chosen(centre) holds."""
    with bmesh_of(target.data) as bm:
        gone = [f for f in bm.faces if chosen(f.calc_center_median())]
        bmesh.ops.delete(bm, geom=gone, context="FACES")
    activate(target)
    return target


def radii(target):
    return np.linalg.norm(positions(target.data), axis=1)


def is_closed(mesh):
    bm = bmesh.new()
    bm.from_mesh(mesh)
    closed = all(e.is_contiguous for e in bm.edges)
    bm.free()
    return closed


def borders(target, chosen=lambda z: True):
    mesh, faces = target.data, faces_at_edges(target.data)
    low = [mesh.vertices[e.vertices[0]].co[2] for e in mesh.edges]
    return [k for k, count in enumerate(faces) if count == 1 and chosen(low[k])]
