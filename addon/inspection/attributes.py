# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature as plain attributes of a mesh: numbers for the user's own nodes, colours to look at.

They exist as long as an object shows curvature, and go with it.
"""

import json

import numpy as np

from ..read.mesh import read_mesh
from . import colours
from .curvature import curvature

COLOUR = "Fairing Curvature"  # also in the material
VALUES = {"MEAN": "fair_mean_curvature", "GAUSS": "fair_gauss_curvature", "TOTAL": "fair_total_curvature"}
INNER = "fair_curvature_measured"  # false at borders and sharp edges, whose values come from the neighbours
RANGE = "fairing_curvature_range"  # custom property of the mesh: [lowest, highest] as JSON, for the legend
_BEFORE = "fairing_active_colour"  # custom property of the mesh: the colour attribute that was active


def write_values(mesh):
    """Measures `mesh` (bpy.types.Mesh, not in Edit Mode) and stores all three curvatures at its vertices."""
    bent = curvature(read_mesh(mesh))
    for name, values in zip(VALUES.values(), (bent.mean, bent.gauss, bent.total), strict=True):
        _attribute(mesh, name, "FLOAT").data.foreach_set("value", values.astype(np.float32))
    _attribute(mesh, INNER, "BOOLEAN").data.foreach_set("value", bent.inner)


def have_values(mesh):
    """Whether write_values ran on this mesh."""
    return all(name in mesh.attributes for name in (*VALUES.values(), INNER))


def write_colours(mesh, mode, settings):
    """Colours of one of the stored curvatures. `settings`: range_low, range_high, use_fixed_range, fixed_range."""
    values = _read(mesh, VALUES[mode], np.float32)
    inner = _read(mesh, INNER, bool)
    signed = mode != "TOTAL"
    if settings.use_fixed_range:
        limits = (-settings.fixed_range if signed else 0.0, settings.fixed_range)
    else:
        limits = colours.value_range(values, inner, signed, settings.range_low, settings.range_high)
    _remember_active(mesh)
    rgba = colours.colours(values, limits, signed)
    _attribute(mesh, COLOUR, "FLOAT_COLOR").data.foreach_set("color", rgba.ravel())
    mesh.color_attributes.active_color = mesh.color_attributes[COLOUR]  # what Solid shading shows
    mesh[RANGE] = json.dumps(limits)
    mesh.update()


def remove(mesh):
    """Takes all of it off the mesh again and makes the colours active that were."""
    for name in (*VALUES.values(), INNER, COLOUR):
        attribute = mesh.attributes.get(name)
        if attribute is not None:
            mesh.attributes.remove(attribute)
    before = mesh.color_attributes.get(mesh.get(_BEFORE, ""))
    if before is not None:
        mesh.color_attributes.active_color = before
    for key in (_BEFORE, RANGE):
        if key in mesh:
            del mesh[key]


def legend(mesh):
    """(lowest, highest) of the colours, or None."""
    return json.loads(mesh[RANGE]) if RANGE in mesh else None


def _remember_active(mesh):
    active = mesh.color_attributes.active_color
    if active is not None and active.name != COLOUR:
        mesh[_BEFORE] = active.name


def _attribute(mesh, name, data_type):
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) == (data_type, "POINT"):
        return attribute
    if attribute is not None:
        mesh.attributes.remove(attribute)
    mesh.attributes.new(name, data_type, "POINT")
    return mesh.attributes[name]


def _read(mesh, name, dtype):
    values = np.empty(len(mesh.vertices), dtype)
    mesh.attributes[name].data.foreach_get("value", values)
    return values
