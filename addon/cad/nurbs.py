# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches as Blender's NURBS surfaces, one each, with the control points that CAD will get."""

from typing import Any, cast

import bpy
import numpy as np

from ..blender import Context, Object

_DEGREE = 3
_RESOLUTION = 4  # steps a span, for display


def surface_of(
    context: Context, name: str, patches: Any, materials: list[Any], slots: np.ndarray | None
) -> Any:
    """New bpy.types.Curve in the coordinates of `patches`; `slots` (P,): into `materials`."""
    nets = [patches.net(p) for p in range(len(patches))]
    surface: Any = bpy.data.curves.new(name, "SURFACE")
    for material in materials:
        surface.materials.append(material)
    for net in nets:
        row = surface.splines.new("NURBS")
        row.points.add(len(net) - 1)
        row.points.foreach_set("co", _with_weights(net[:, 0]))
    _add_rows(context, surface, [net.shape[1] for net in nets])
    for p, (spline, net) in enumerate(zip(surface.splines, nets, strict=True)):
        for direction in "uv":
            setattr(spline, f"order_{direction}", _DEGREE + 1)
            setattr(spline, f"use_endpoint_{direction}", True)
            setattr(spline, f"resolution_{direction}", _RESOLUTION)
        spline.points.foreach_set("co", _with_weights(net.transpose(1, 0, 2)))
        spline.use_smooth = True
        if slots is not None:
            spline.material_index = int(slots[p])
    return surface


def _with_weights(points: np.ndarray) -> np.ndarray:
    """x, y, z and a weight of 1 for each point."""
    rows = points.reshape(-1, 3)
    return np.column_stack([rows, np.ones(len(rows))]).astype(np.float32).ravel()


def _add_rows(context: Context, surface: Any, rows: list[int]) -> None:
    """Extrudes each spline's single row to `rows`, since scripts cannot make a grid of points."""
    stand_in = cast(Object, bpy.data.objects.new(surface.name, surface))
    before = context.view_layer.objects.active
    context.scene.collection.objects.link(stand_in)
    try:
        context.view_layer.objects.active = stand_in
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.curve.select_all(action="SELECT")
        for row in range(1, max(rows, default=1)):
            for spline, wanted in zip(surface.splines, rows, strict=True):
                if wanted == row:
                    spline.points.foreach_set("select", np.zeros(len(spline.points), bool))
            bpy.ops.curve.extrude()
        bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        bpy.data.objects.remove(stand_in)
        context.view_layer.objects.active = before
