# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour of each face in CAD files, from its material."""

from typing import Any

import numpy as np
from mathutils import Color

from ..blender import Object
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
