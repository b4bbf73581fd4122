# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces that are selected in Edit Mode."""

import numpy as np

NONE_SELECTED = (
    "no face is selected. Select the faces to fair in Edit Mode, or switch off Selected Faces Only."
)


def selected_faces(mesh):
    """(r,) int32: ids of the selected and visible faces of a bpy.types.Mesh."""
    selected, hidden = np.empty(len(mesh.polygons), bool), np.empty(len(mesh.polygons), bool)
    mesh.polygons.foreach_get("select", selected)
    mesh.polygons.foreach_get("hide", hidden)
    return np.flatnonzero(selected & ~hidden).astype(np.int32)
