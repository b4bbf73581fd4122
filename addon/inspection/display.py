# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches what an object shows: itself, zebra stripes, or its curvature."""

import bpy

from . import attributes, override
from .curvature_material import MODE as CURVATURE
from .curvature_material import curvature_material
from .zebra import zebra_material

CURVATURES = tuple(attributes.VALUES)


def show(target, mode, settings):
    """Makes `target` (a mesh object) show `mode`: NONE, ZEBRA, MEAN, GAUSS or TOTAL. Its own materials are not touched.

    In Edit Mode no curvature is measured: call `refresh` afterwards.
    """
    if mode not in CURVATURES:
        _clear_attributes(target)
    if mode == "NONE":
        override.take_off(target)
    elif mode == "ZEBRA":
        override.put_on(target, "ZEBRA", zebra_material(settings), settings.smooth)
    else:
        if target.mode != "EDIT":
            attributes.write_values(target.data)
            attributes.write_colours(target.data, mode, settings)
        override.put_on(target, CURVATURE, curvature_material(), settings.smooth)


def refresh(target, settings):
    """Measures anew what `target` shows; for after its mesh was changed or replaced. Nothing to do if it shows itself."""
    mode = target.discrete_fairing_inspection.mode
    if mode != "NONE":
        show(target, mode, settings)


def remeasure(target, settings):
    """Measures anew the curvature that `target` shows; for after its points have moved. Nothing to do if it shows none."""
    mode = target.discrete_fairing_inspection.mode
    if mode in CURVATURES:
        attributes.write_values(target.data)
        attributes.write_colours(target.data, mode, settings)


def recolour(target, settings):
    """Colours by other limits what was measured before."""
    mode = target.discrete_fairing_inspection.mode
    if mode in CURVATURES and target.mode != "EDIT":
        if not attributes.have_values(target.data):
            attributes.write_values(target.data)
        attributes.write_colours(target.data, mode, settings)


def set_smooth(target, settings):
    """Shades `target` smooth or not while it is inspected."""
    modifier = override.find(target)
    if modifier is not None:
        override.set_smooth(modifier.node_group, settings.smooth)


def _clear_attributes(target):
    if target.mode != "EDIT" and not _shared_with_others(target):
        attributes.remove(target.data)


def _shared_with_others(target):
    """Whether another object shows the curvature of the same mesh."""
    return target.data.users > 1 and any(
        other.discrete_fairing_inspection.mode in CURVATURES
        for other in bpy.data.objects
        if other.data == target.data and other != target
    )
