# SPDX-License-Identifier: GPL-3.0-or-later
"""The new object beside its source: same place, same collections, same materials."""

import json

import bpy

from ..settings.properties import copy_settings

REPORT = "fairing_report"  # custom property of the new object: the core's report as JSON

_TRANSFORM = (
    "rotation_mode",  # first: the others are read by it
    "location",
    "rotation_euler",
    "rotation_quaternion",
    "rotation_axis_angle",
    "scale",
    "delta_location",
    "delta_rotation_euler",
    "delta_rotation_quaternion",
    "delta_scale",
)
_PARENT = ("parent", "parent_type", "parent_bone", "parent_vertices", "matrix_parent_inverse")


def new_object(context, source, mesh):
    """Links a new object for `mesh` beside `source` and returns it. The source is only read."""
    target = bpy.data.objects.new(mesh.name, mesh)
    for collection in _collections(context, source):
        collection.objects.link(target)
    _copy_place(context, source, target)
    _copy_object_materials(source, target)
    return target


def replace_mesh(target, mesh):
    """Puts `mesh` in the place of the mesh of `target`, for all objects that share it, and returns `target`.

    The materials are those that the old mesh has by now, and its name goes on.
    """
    old = target.data
    mesh.materials.clear()
    for material in old.materials:
        mesh.materials.append(material)
    name = old.name
    old.user_remap(mesh)
    bpy.data.meshes.remove(old)
    mesh.name = name
    return target


def remember(target, source, settings, report):
    """Notes on `target` where it comes from, so that it can be computed again, and what the core reported."""
    memory = target.discrete_fairing
    memory.source = source
    copy_settings(settings, memory)
    target[REPORT] = json.dumps(report, default=_plain)


def select_only(context, objects):
    """Selects `objects` and nothing else; the last one becomes active."""
    for other in context.view_layer.objects.selected[:]:
        other.select_set(False)
    for target in objects:
        target.select_set(True)
    context.view_layer.objects.active = objects[-1]


def _collections(context, source):
    own = [collection for collection in source.users_collection if not collection.library]
    return own or [context.collection]


def _copy_place(context, source, target):
    if source.parent is not None:
        for name in _PARENT:
            setattr(target, name, getattr(source, name))
    for name in _TRANSFORM:
        setattr(target, name, getattr(source, name))
    if source.constraints:  # not copied, what they did is
        context.view_layer.update()
        target.matrix_world = source.matrix_world


def _copy_object_materials(source, target):
    """Slots that hold their material in the object, not in the mesh."""
    for own, theirs in zip(target.material_slots, source.material_slots):
        if theirs.link == "OBJECT":
            own.link = "OBJECT"
            own.material = theirs.material


def _plain(value):
    """NumPy scalars and arrays, and mappings that are no dict, for JSON."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "items"):
        return dict(value)
    return str(value)
