# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that the control mesh carries, written to the refined mesh and its object."""

import numpy as np

from .attributes import inherit, write_attributes
from .groups import write_groups


def write_data(target, data, carrier, leave_out=()):
    """Gives the object `target`, in Object Mode with the refined mesh, what `data` (SurfaceData) holds; `carrier`: Carrier.

    Attributes named in `leave_out` are not written. Sharp edges add up with those that are there.
    Shape keys: see shape_keys.py; they come last, since attributes of a mesh that has them are harder to change.
    """
    mesh = target.data
    origin = carrier.edge_origin(_corner_edges(mesh), len(mesh.edges))
    write_attributes(mesh, data.attributes, carrier, origin, leave_out)
    for name, values in data.edge_marks.items():
        mesh.edges.foreach_set(name, inherit(values, origin))
    for name, values in data.face_marks.items():
        mesh.polygons.foreach_set(name, carrier.face(values))
    write_groups(target, data.groups, data.active_group, carrier)
    _choose_active(mesh, data)
    mesh.update()


def _corner_edges(mesh):
    edges = np.empty(len(mesh.loops), np.int32)
    if len(edges):
        mesh.attributes[".corner_edge"].data.foreach_get("value", edges)
    return edges


def _choose_active(mesh, data):
    """Which UV map and which colours are shown and rendered. New ones push themselves forward, so this comes last."""
    if data.active_uv in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[data.active_uv]
    if data.render_uv in mesh.uv_layers:
        mesh.uv_layers[data.render_uv].active_render = True
    mesh.attributes.active_color_name = data.active_color
    mesh.attributes.default_color_name = data.default_color
