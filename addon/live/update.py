# SPDX-License-Identifier: GPL-3.0-or-later
"""A live result into the mesh that an object has: as a whole once, then positions alone."""

from ..carry.carrier import Carrier
from ..carry.lattice import fine_edges
from ..write.data import write_data
from ..write.mesh import fill_mesh, write_positions


def build(target, result, arrays, data, settings, level):
    """Gives the mesh of `target` the geometry of `result` and what the control mesh carries, shape keys excepted.

    The mesh, its materials and the object's modifiers stay.
    """
    mesh = target.data
    if mesh.shape_keys is not None:
        target.shape_key_clear()
    mesh.clear_geometry()
    fill_mesh(mesh, result, fine_edges(result.faces, result.crease_edges, level))
    carrier = Carrier(result, arrays, level)
    write_data(target, data, carrier, ("sharp_face",) if settings.shade_smooth else ())


def move(target, result):
    """Moves the points of a mesh that was built of the same faces."""
    write_positions(target.data, result.vertices)


def fits(mesh, result):
    """Whether `mesh` can have been built of the faces of `result`: nobody has put another one in its place."""
    triangles, quads = result.faces
    return (
        len(mesh.vertices) == len(result.vertices)
        and len(mesh.polygons) == len(triangles) + len(quads)
        and mesh.shape_keys is None
    )
