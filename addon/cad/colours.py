# SPDX-License-Identifier: GPL-3.0-or-later
"""Which colour each face has in CAD: that of its material."""

from typing import Any

import numpy as np
from mathutils import Color

from ..blender import Object
from ..mesh.layers import SurfaceData

PLAIN = (0.8, 0.8, 0.8)  # of faces without a material
FAULTY = (1.0, 0.0, 0.0)


def materials(shown: Object, source: Object) -> list[Any]:
    """Those of the surface, which may have others than its source, as its slots show them."""
    owner = shown if len(shown.material_slots) else source
    return [slot.material for slot in owner.material_slots]


def of_faces(
    shown: Object, source: Object, data: SurfaceData
) -> tuple[np.ndarray | None, np.ndarray]:
    """(m, 3) red, green and blue of each face of the source, None where there is no material; and
    (m,) the slot of each, empty where all are in the first.
    """
    found = [a.values for a in data.attributes if (a.name, a.domain) == ("material_index", "FACE")]
    slots = np.maximum(found[0], 0) if found else np.empty(0, np.int32)
    shades = np.array([_colour(material) for material in materials(shown, source)])
    if not len(shades):
        return None, slots
    if not len(slots):
        return shades[:1], slots
    return shades[np.minimum(slots, len(shades) - 1)], slots


def of_patches(faces: np.ndarray | None, patches: Any) -> np.ndarray | None:
    """(3,) or (P, 3) for `write_step`, from what `of_faces` has found; the patches of faces that are
    not resolved are marked.
    """
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
    """What a material looks like, as screens have it; CAD has no lights."""
    if material is None:
        return PLAIN
    shown = Color(_base(material)[:3]).from_scene_linear_to_srgb()
    red, green, blue = (min(max(round(v, 4), 0.0), 1.0) for v in (shown.r, shown.g, shown.b))
    return red, green, blue


def _base(material: Any) -> Any:
    """Its Principled BSDF's base colour, unless that comes from a texture; else what the viewport
    shows.
    """
    for node in material.node_tree.nodes if material.use_nodes and material.node_tree else ():
        if node.type == "BSDF_PRINCIPLED" and not node.inputs["Base Color"].is_linked:
            return node.inputs["Base Color"].default_value
    return material.diffuse_color
