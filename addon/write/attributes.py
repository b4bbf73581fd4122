# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of the control mesh, written to the refined one in bulk."""

import numpy as np

from ..read.attributes import STORAGE

# A crease or bevel weight says what to do at one vertex. Spread over the faces around it, it would say it everywhere.
_OWN_VERTICES_ONLY = {"crease_vert", "bevel_weight_vert"}


def write_attributes(mesh, attributes, carrier, origin, leave_out=()):
    """Gives `mesh` all `attributes` (list of Attribute) but those named in `leave_out`.

    `origin` (refined edges,): the control edge of each, or -1.
    """
    for attribute in attributes:
        if attribute.name not in leave_out:
            _write(mesh, attribute, _carried(attribute, carrier, origin))


def inherit(values, origin):
    """(e, …) values of control edges → those of their pieces; 0 or False on all other refined edges."""
    found = origin >= 0
    out = np.zeros((len(origin), *values.shape[1:]), values.dtype)
    out[found] = values[origin[found]]
    return out


def _carried(attribute, carrier, origin):
    values, mixable = attribute.values, STORAGE[attribute.data_type].mixable
    if attribute.domain == "EDGE":
        return inherit(values, origin)
    if attribute.domain == "FACE":
        return carrier.face(values)
    if attribute.domain == "CORNER":
        return carrier.corner(values) if mixable else carrier.pick_corner(values)
    if attribute.name in _OWN_VERTICES_ONLY:
        return carrier.own_point(values)
    return carrier.point(values) if mixable else carrier.pick_point(values)


def _write(mesh, attribute, values):
    name, data_type, domain = attribute.name, attribute.data_type, attribute.domain
    target = mesh.attributes.get(name)
    if target is not None and (target.data_type, target.domain) != (data_type, domain):
        mesh.attributes.remove(target)
        target = None
    if target is None:
        target = mesh.attributes.new(name, data_type, domain)
    elif name == "sharp_edge":  # the surface's own creases
        values = values | _bools(target)
    storage = STORAGE[data_type]
    if storage.dtype is object:
        for i in np.flatnonzero(values.astype(bool)).tolist():
            target.data[i].value = values[i]
    else:
        target.data.foreach_set(storage.field, np.ascontiguousarray(values, storage.dtype).ravel())


def _bools(attribute):
    values = np.empty(len(attribute.data), bool)
    attribute.data.foreach_get("value", values)
    return values
