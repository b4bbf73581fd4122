# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour of each face in CAD files, from its material; and patches as Blender's NURBS surfaces, one each, with the control
points that CAD will get.
"""

from typing import Any, cast

import bpy
import numpy as np
from mathutils import Color

from ..blender import Context, Object
from ..mesh.layers import SurfaceData

PLAIN = (0.8, 0.8, 0.8)  # for faces without a material
FAULTY = (1.0, 0.0, 0.0)


def materials(shown: Object, source: Object) -> list[Any]:
    """The surface's materials, from its slots; they may differ from its source's."""
    owner = shown if len(shown.material_slots) else source
    return [slot.material for slot in owner.material_slots]


def of_faces(
    shown: Object, source: Object, data: SurfaceData
) -> tuple[np.ndarray | None, np.ndarray]:
    """(m, 3) colour of each face, None without materials; (m,) its slot, empty if one is used."""
    found = [a.values for a in data.attributes if (a.name, a.domain) == ("material_index", "FACE")]
    slots = np.maximum(found[0], 0) if found else np.empty(0, np.int32)
    shades = np.array([_colour(material) for material in materials(shown, source)])
    if not len(shades):
        return None, slots
    if not len(slots):
        return shades[:1], slots
    return shades[np.minimum(slots, len(shades) - 1)], slots


def of_patches(faces: np.ndarray | None, patches: Any) -> np.ndarray | None:
    """(3,) or (P, 3) for `write_step`, from `of_faces`; unresolved patches are marked."""
    count = len(patches)
    if faces is None or len(faces) == 1:
        own = None if faces is None else np.repeat(faces, count, axis=0)
    else:
        own = faces[patches.patch_polygon]
    if len(patches.unresolved):
        own = np.full((count, 3), PLAIN) if own is None else own
        own[patches.covering(patches.unresolved)] = FAULTY
    if own is None or not count:
        return None
    return own[0] if (own == own[0]).all() else own


def _colour(material: Any) -> tuple[float, float, float]:
    """The colour of a material as displayed on screens; CAD files have no lights."""
    if material is None:
        return PLAIN
    shown = Color(_base(material)[:3]).from_scene_linear_to_srgb()
    red, green, blue = (min(max(round(v, 4), 0.0), 1.0) for v in (shown.r, shown.g, shown.b))
    return red, green, blue


def _base(material: Any) -> Any:
    """The base colour of its Principled BSDF, unless a texture provides it; else the viewport's colour."""
    for node in material.node_tree.nodes if material.use_nodes and material.node_tree else ():
        if node.type == "BSDF_PRINCIPLED" and not node.inputs["Base Color"].is_linked:
            return node.inputs["Base Color"].default_value
    return material.diffuse_color


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
