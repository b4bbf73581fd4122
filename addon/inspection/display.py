# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches what an object shows: itself, zebra stripes, or curvature as colours of its mesh."""

from typing import Any

from ..blender import Mesh, Object, all_objects
from ..mesh.layers import fill_layer, layer_values, make_layer
from ..mesh.read import read_mesh
from . import measures, viewport_material
from .curvature import curvature
from .materials import COLOUR, CURVATURE_MODE, ZEBRA_MODE, curvature_material, zebra_material

VALUES = {
    "MEAN": "fair_mean_curvature",
    "GAUSS": "fair_gauss_curvature",
    "TOTAL": "fair_total_curvature",
}
# false at borders and sharp edges, whose values come from the neighbours
INNER = "fair_curvature_measured"

CURVATURES = tuple(VALUES)


def write_values(mesh: Mesh) -> None:
    """Measures `mesh` (bpy.types.Mesh, not in Edit Mode) and stores all three curvatures at its
    vertices.
    """
    bent = curvature(read_mesh(mesh))
    for name, values in zip(VALUES.values(), (bent.mean, bent.gauss, bent.total), strict=True):
        fill_layer(make_layer(mesh, name, "FLOAT", "POINT"), values)
    fill_layer(make_layer(mesh, INNER, "BOOLEAN", "POINT"), bent.inner)


def have_values(mesh: Mesh) -> bool:
    """Whether write_values ran on this mesh."""
    return all(name in mesh.attributes for name in (*VALUES.values(), INNER))


def write_colours(mesh: Mesh, mode: str, settings: Any) -> None:
    """Colours of one of the stored curvatures.

    `settings`: range_low, range_high, use_fixed_range, fixed_range.
    """
    values = layer_values(mesh.attributes[VALUES[mode]])
    inner = layer_values(mesh.attributes[INNER])
    signed = mode != "TOTAL"
    if settings.use_fixed_range:
        limits = (-settings.fixed_range if signed else 0.0, settings.fixed_range)
    else:
        limits = measures.value_range(
            values, inner, signed, settings.range_low, settings.range_high
        )
    _remember_active(mesh)
    rgba = measures.colours_of(values, limits, signed)
    fill_layer(make_layer(mesh, COLOUR, "FLOAT_COLOR", "POINT"), rgba)
    mesh.color_attributes.active_color = mesh.color_attributes[COLOUR]  # what Solid shading shows
    mesh.discrete_fairing.curvature_range = limits
    mesh.update()


def remove_values(mesh: Mesh) -> None:
    """Takes all of it off the mesh again and makes the colours active that were."""
    for name in (*VALUES.values(), INNER, COLOUR):
        attribute = mesh.attributes.get(name)
        if attribute is not None:
            mesh.attributes.remove(attribute)
    before = mesh.color_attributes.get(mesh.discrete_fairing.active_colour)
    if before is not None:
        mesh.color_attributes.active_color = before
    for name in ("active_colour", "curvature_range"):
        mesh.discrete_fairing.property_unset(name)


def legend(mesh: Mesh) -> tuple[float, ...] | None:
    """(lowest, highest) of the measures, or None."""
    known = mesh.discrete_fairing
    return tuple(known.curvature_range) if known.is_property_set("curvature_range") else None


def _remember_active(mesh: Mesh) -> None:
    active = mesh.color_attributes.active_color
    if active is not None and active.name != COLOUR:
        mesh.discrete_fairing.active_colour = active.name


def show(target: Object, mode: str, settings: Any) -> None:
    """Makes `target` (a mesh object) show `mode`: NONE, ZEBRA, MEAN, GAUSS or TOTAL. Its own
    materials are not touched.

    In Edit Mode no curvature is measured: call `refresh` afterwards.
    """
    if mode not in CURVATURES:
        _clear_attributes(target)
    if mode == "NONE":
        viewport_material.take_off(target)
    elif mode == "ZEBRA":
        viewport_material.put_on(target, ZEBRA_MODE, zebra_material(settings), settings)
    else:
        if target.mode != "EDIT":
            write_values(target.data)
            write_colours(target.data, mode, settings)
        viewport_material.put_on(target, CURVATURE_MODE, curvature_material(), settings)


def refresh(target: Object, settings: Any) -> None:
    """Measures anew what `target` shows; for after its mesh was changed or replaced.

    Nothing to do if it shows itself.
    """
    mode = target.discrete_fairing_inspection.mode
    if mode != "NONE":
        show(target, mode, settings)


def remeasure(target: Object, settings: Any) -> None:
    """Measures anew the curvature that `target` shows; for after its points have moved.

    Nothing to do if it shows none.
    """
    mode = target.discrete_fairing_inspection.mode
    if mode in CURVATURES:
        write_values(target.data)
        write_colours(target.data, mode, settings)


def recolour(target: Object, settings: Any) -> None:
    """Colours by other limits what was measured before."""
    mode = target.discrete_fairing_inspection.mode
    if mode in CURVATURES and target.mode != "EDIT":
        if not have_values(target.data):
            write_values(target.data)
        write_colours(target.data, mode, settings)


def redraw(target: Object, settings: Any) -> None:
    """Shows what `target` shows as `settings`, of a scene that it is in, have it by now: stripes,
    smooth or not. Nothing is measured.
    """
    mode = target.discrete_fairing_inspection.mode
    if mode == "ZEBRA":
        viewport_material.put_on(target, ZEBRA_MODE, zebra_material(settings), settings)
    elif mode in CURVATURES:
        viewport_material.put_on(target, CURVATURE_MODE, curvature_material(), settings)


def _clear_attributes(target: Object) -> None:
    if target.mode != "EDIT" and not _shared_with_others(target):
        remove_values(target.data)


def _shared_with_others(target: Object) -> bool:
    """Whether another object shows the curvature of the same mesh."""
    return target.data.users > 1 and any(
        other.discrete_fairing_inspection.mode in CURVATURES
        for other in all_objects()
        if other.data == target.data and other != target
    )
