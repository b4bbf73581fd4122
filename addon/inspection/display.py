# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches the display of an object: itself, stripes, or values at its vertices as colours."""

from typing import Any

import numpy as np

from ..blender import Context, Mesh, Object, Scene, all_objects, column, current_context
from ..memory import scans_of, source_of
from ..mesh.layers import fill_layer, layer_values, make_layer
from ..mesh.read import control_mesh, read_mesh
from ..mesh.scans import read_scans
from ..mesh.world_shape import world_shape
from ..mesh.write import NO_POINTS, faces_without_points
from ..settings import is_evaluated
from ..units import curvature_text, length_text
from . import colours, deviation
from .curvature import curvature
from .materials import (
    COLOUR,
    CURVATURE_MODE,
    STRIPES,
    curvature_material,
    put_on,
    stripes_material,
    take_off,
)

CURVATURES = {
    "MEAN": "fair_mean_curvature",
    "GAUSS": "fair_gauss_curvature",
    "TOTAL": "fair_total_curvature",
}
# modes that show colours, and the attributes with their values
VALUES = {**CURVATURES, "DEVIATION": "fair_deviation"}
QUICK = 10_000  # vertices whose deviation is computed within a redraw
# false at borders and sharp edges, whose curvature is that of the neighbours
INNER = "fair_curvature_measured"


def write_values(target: Object, mode: str, settings: Any) -> None:
    """Measures `target`, not in Edit Mode, and stores the values of `mode`, or all curvatures."""
    if mode == "DEVIATION":
        _write_deviation(current_context(), target, settings.deviation_object)
        return
    mesh = target.data
    bent = curvature(world_shape(target).of_arrays(read_mesh(mesh)))
    for name, values in zip(CURVATURES.values(), (bent.mean, bent.gauss, bent.total), strict=True):
        fill_layer(make_layer(mesh, name, "FLOAT", "POINT"), values)
    fill_layer(make_layer(mesh, INNER, "BOOLEAN", "POINT"), bent.inner)


def _write_deviation(context: Context, target: Object, other: Object | None) -> None:
    """Deviation from `other`; None: from its scans, or from the control vertices, if it has a source."""
    positions = read_mesh(target.data).positions
    source = source_of(target)
    scans = scans_of(target) if other is None else [other]
    if scans:
        values = deviation.from_scan(target, positions, read_scans(context, scans))
    elif source is not None:
        with control_mesh(context, source, is_evaluated(target.discrete_fairing)) as mesh:
            control = read_mesh(mesh).positions
        values = deviation.from_vertices(target, positions, control)
    else:
        values = np.zeros(len(positions))
    fill_layer(make_layer(target.data, VALUES["DEVIATION"], "FLOAT", "POINT"), values)


def have_values(mesh: Mesh, mode: str) -> bool:
    names = (VALUES[mode],) if mode == "DEVIATION" else (*CURVATURES.values(), INNER)
    return all(name in mesh.attributes for name in names)


def write_colours(mesh: Mesh, mode: str, settings: Any) -> None:
    """Writes the colours of stored values, by the ranges of `settings`."""
    values = layer_values(mesh.attributes[VALUES[mode]])
    inner = np.ones(len(values), bool)
    if mode in CURVATURES:
        inner = layer_values(mesh.attributes[INNER])
    bare = _corners_without_points(mesh, mode, settings)
    if bare is not None:
        corners = layer_values(mesh.attributes[".corner_vert"])
        inner[:] = False
        inner[corners[~bare]] = True
    signed = mode != "TOTAL"
    if settings.use_fixed_range:
        limit = settings.fixed_deviation if mode == "DEVIATION" else settings.fixed_range
        limits = (-limit if signed else 0.0, limit)
    else:
        limits = colours.value_range(values, inner, signed)
    rgba = colours.colours_of(values, limits, signed)
    if bare is not None:
        rgba = rgba[corners]
        rgba[bare] = (*colours.NEUTRAL, 1.0)
    domain = "POINT" if bare is None else "CORNER"
    fill_layer(make_layer(mesh, COLOUR, "FLOAT_COLOR", domain), rgba)
    mesh.discrete_fairing.curvature_range = limits
    mesh.update()


def _corners_without_points(mesh: Mesh, mode: str, settings: Any) -> np.ndarray | None:
    """(c,) bool: corners without points of scans, where deviation is undefined; None: all have."""
    if (
        mode != "DEVIATION"
        or settings.deviation_object is not None
        or NO_POINTS not in mesh.attributes
    ):
        return None
    sizes = column(mesh.polygons, "loop_total", np.int32)
    bare = np.repeat(faces_without_points(mesh), sizes)
    return bare if bare.any() else None


def shows_uncovered(mesh: Mesh) -> bool:
    """Whether faces without points have their own colour: by corners, since their borders are sharp."""
    layer = mesh.attributes.get(COLOUR)
    return layer is not None and layer.domain == "CORNER"


def remove_values(mesh: Mesh) -> None:
    for name in (*VALUES.values(), INNER, COLOUR):
        attribute = mesh.attributes.get(name)
        if attribute is not None:
            mesh.attributes.remove(attribute)
    mesh.discrete_fairing.property_unset("curvature_range")


def legend(mesh: Mesh) -> tuple[float, ...] | None:
    """(lowest, highest) value of the colours, or None."""
    known = mesh.discrete_fairing
    return tuple(known.curvature_range) if known.is_property_set("curvature_range") else None


def value_text(scene: Scene, mode: str, value: float) -> str:
    """A value of `mode`, one of VALUES, with its unit."""
    if mode == "DEVIATION":
        return length_text(scene, value)
    return curvature_text(scene, value, 1 if mode == "MEAN" else 2)


def show(target: Object, mode: str, settings: Any) -> None:
    """Shows `mode`: NONE, one of STRIPES or VALUES. Edit Mode measures nothing: `refresh` later."""
    if mode not in VALUES and target.mode != "EDIT" and not _shared_with_others(target):
        remove_values(target.data)
    if mode == "NONE":
        take_off(target)
    elif mode in VALUES and target.mode != "EDIT":
        write_values(target, mode, settings)
        write_colours(target.data, mode, settings)
    redraw(target, settings, mode)


def refresh(target: Object, settings: Any) -> None:
    """Measures the values shown again, if any, after the mesh was changed or replaced."""
    mode = target.discrete_fairing_inspection.mode
    if mode != "NONE":
        show(target, mode, settings)


def remeasure(target: Object, settings: Any) -> None:
    """Measures the shown colours again while points move, if quick; else `refresh` later."""
    mode = target.discrete_fairing_inspection.mode
    if mode not in VALUES:
        return
    if _is_quick(target, mode, settings):
        write_values(target, mode, settings)
    elif not have_values(target.data, mode):
        blank = np.zeros(len(target.data.vertices))
        fill_layer(make_layer(target.data, VALUES[mode], "FLOAT", "POINT"), blank)
    write_colours(target.data, mode, settings)


def _is_quick(target: Object, mode: str, settings: Any) -> bool:
    """Whether a measurement is quick: distances take a search for each point, or face too."""
    if mode != "DEVIATION":
        return True
    other = settings.deviation_object is not None or scans_of(target)
    return not other and len(target.data.vertices) <= QUICK


def recolour(target: Object, settings: Any) -> None:
    """Colours the stored values with new limits."""
    mode = target.discrete_fairing_inspection.mode
    if mode in VALUES and target.mode != "EDIT":
        if not have_values(target.data, mode):
            write_values(target, mode, settings)
        write_colours(target.data, mode, settings)


def redraw(target: Object, settings: Any, mode: str = "") -> None:
    """Updates stripes and smoothness to the `settings` of the scene; measures nothing."""
    mode = mode or target.discrete_fairing_inspection.mode
    if mode in STRIPES:
        put_on(target, mode, stripes_material(mode, settings), settings)
    elif mode in VALUES:
        put_on(target, CURVATURE_MODE, curvature_material(), settings)


def _shared_with_others(target: Object) -> bool:
    """Whether another object shows values of the same mesh."""
    return target.data.users > 1 and any(
        other.discrete_fairing_inspection.mode in VALUES
        for other in all_objects()
        if other.data == target.data and other != target
    )
