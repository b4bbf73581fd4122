# SPDX-License-Identifier: GPL-3.0-or-later
"""The modifiers of the source, copied to the refined object by Blender itself."""

import bpy

from .drivers import copy_drivers

# type: the operator that binds and unbinds, the property that says which
_BOUND = {
    "SURFACE_DEFORM": ("surfacedeform_bind", "is_bound"),
    "MESH_DEFORM": ("meshdeform_bind", "is_bound"),
    "LAPLACIANDEFORM": ("laplaciandeform_bind", "is_bind"),
    "CORRECTIVE_SMOOTH": ("correctivesmooth_bind", "is_bind"),
}
_USELESS = {"MULTIRES": "its sculpted detail belongs to the faces of the control mesh"}


def copy_modifiers(context, source, target):
    """Replaces the modifiers of the object `target` with those of `source`, with their settings, targets and drivers.

    Both objects have to be in the view layer, in Object Mode. Returns what could not be copied, a sentence each.
    """
    if not len(source.modifiers):
        return []
    both = [source, target]
    with context.temp_override(
        object=source, active_object=source, selected_objects=both, selected_editable_objects=both
    ):
        bpy.ops.object.make_links_data(type="MODIFIERS")
    notes = _missing(source, target) + _drop_useless(target) + _unbind(context, target)
    copy_drivers(source, target, "modifiers[")
    return notes


def _missing(source, target):
    return [
        f"The modifier '{modifier.name}' is not copied: Blender does not copy this kind."
        for modifier in source.modifiers
        if modifier.name not in target.modifiers
    ]


def _drop_useless(target):
    notes = []
    for modifier in [m for m in target.modifiers if m.type in _USELESS]:
        notes.append(f"The modifier '{modifier.name}' is not copied: {_USELESS[modifier.type]}.")
        target.modifiers.remove(modifier)
    return notes


def _unbind(context, target):
    """Bindings are lists of the control mesh's vertices: on another mesh they only raise errors."""
    notes = []
    for modifier in target.modifiers:
        operator, bound = _BOUND.get(modifier.type, ("", ""))
        if not operator or not getattr(modifier, bound):
            continue
        with context.temp_override(object=target, active_object=target):
            getattr(bpy.ops.object, operator)(modifier=modifier.name)
        notes.append(f"The modifier '{modifier.name}' is copied without its binding: bind it again.")
    return notes
