# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies the modifiers of the source to the refined object, by Blender itself."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, cast

import bpy

from ..blender import Context, Object
from ..words import listed
from .object import copy_drivers

# custom property of the modifier that shows an inspected object in another material, which is not
# copied
INSPECTION_TAG = "fairing_inspection"

# type: the operator that binds and unbinds, and the property that tells which
_BOUND = {
    "SURFACE_DEFORM": ("surfacedeform_bind", "is_bound"),
    "MESH_DEFORM": ("meshdeform_bind", "is_bound"),
    "LAPLACIANDEFORM": ("laplaciandeform_bind", "is_bind"),
    "CORRECTIVE_SMOOTH": ("correctivesmooth_bind", "is_bind"),
}
_USELESS = {
    "SUBSURF": "the surface takes its place",
    "MULTIRES": "its sculpted detail belongs to the faces of the control mesh",
}


def copy_modifiers(context: Context, source: Object, target: Object) -> list[str]:
    """Replaces the modifiers of the object `target` by those of `source`, with their settings, targets
    and drivers, but without Subdivision Surface, whose place the surface takes.

    Both objects must be in the view layer. Returns sentences on what could not be copied, which is
    everything if Blender is not in Object Mode.
    """
    if not len(source.modifiers):
        return []
    if context.mode != "OBJECT":
        return ["Modifiers are copied in Object Mode only."]
    both = [source, target]
    with context.temp_override(
        object=source, active_object=source, selected_objects=both, selected_editable_objects=both
    ):
        bpy.ops.object.make_links_data(type="MODIFIERS")
    notes = _missing(source, target) + _drop(target) + _unbind(context, target)
    copy_drivers(source, target, "modifiers[")
    inspection = inspection_modifier(target)
    if inspection is not None:  # the inspection display of the source
        target.modifiers.remove(inspection)
    return notes


def left_out(source: Object, cure: str = "") -> list[str]:
    """Which modifiers a surface of `source` as modelled lacks, and the cure: a sentence, or none. The surface takes
    the place of Subdivision Surface. `cure`: empty for that of fairing.
    """
    missing = [m for m in _shown(source) if m.type != "SUBSURF"]
    axes = [a for m in missing if m.type == "MIRROR" for a, on in zip("XYZ", m.use_axis) if on]
    if not cure and len(axes) == 1:
        cure = f"turn on Copy Modifiers and set Symmetry Plane to {axes[0]}"
    return _without(
        missing, cure or "turn on Copy Modifiers, or set Control Mesh to With Modifiers"
    )


def own_left_out(surface: Object) -> list[str]:
    """Which modifiers of a surface its patches lack: a sentence, or none."""
    return _without(_shown(surface), "its own modifiers are left out")


def inspection_modifier(target: Object) -> Any:
    return next(
        (
            m
            for m in cast(Iterable[Any], target.modifiers)
            if m.type == "NODES" and m.node_group is not None and INSPECTION_TAG in m.node_group
        ),
        None,
    )


@contextmanager
def without_inspection(context: Context, *targets: Object) -> Iterator[None]:
    """Evaluated meshes of `targets` without the inspection modifier, for reading or export."""
    found = [inspection_modifier(target) for target in targets]
    shown = [m for m in found if m is not None and (m.show_viewport or m.show_render)]
    before = [(m.show_viewport, m.show_render) for m in shown]
    for modifier in shown:
        modifier.show_viewport = modifier.show_render = False
    if shown:
        context.view_layer.update()
    try:
        yield
    finally:
        for modifier, (viewport, render) in zip(shown, before, strict=True):
            modifier.show_viewport, modifier.show_render = viewport, render


def _shown(target: Object) -> list[Any]:
    modifiers = cast(Iterable[Any], target.modifiers)
    inspection = inspection_modifier(target)
    return [m for m in modifiers if m.show_viewport and m != inspection]


def _without(missing: list[Any], cure: str) -> list[str]:
    names = listed([modifier.name for modifier in missing])
    return [f"The surface is without {names}: {cure}."] if missing else []


def _missing(source: Object, target: Object) -> list[str]:
    return [
        f"The modifier '{modifier.name}' is not copied: Blender does not copy this kind."
        for modifier in source.modifiers
        if modifier.name not in target.modifiers
    ]


def _drop(target: Object) -> list[str]:
    """Removes the modifiers that are of no use there; returns the reasons, as sentences."""
    notes = []
    for modifier in [m for m in target.modifiers if m.type in _USELESS]:
        notes.append(f"The modifier '{modifier.name}' is not copied: {_USELESS[modifier.type]}.")
        target.modifiers.remove(modifier)
    return notes


def _unbind(context: Context, target: Object) -> list[str]:
    """Bindings list vertices of the control mesh: on another mesh they only raise errors."""
    notes = []
    for modifier in target.modifiers:
        operator, bound = _BOUND.get(modifier.type, ("", ""))
        if not operator or not getattr(modifier, bound):
            continue
        with context.temp_override(object=target, active_object=target):
            getattr(bpy.ops.object, operator)(modifier=modifier.name)
        notes.append(
            f"The modifier '{modifier.name}' is copied without its binding: bind it again."
        )
    return notes
