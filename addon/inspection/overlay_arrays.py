# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrays of the overlay for the graphics card, which can be tested without one."""

from typing import Any

import bpy
import numpy as np

from ..blender import Object, column
from .sections import Drawn, combs, drawn, sections, segments, teeth

CURVE = (0.02, 0.02, 0.02, 1.0)
# for planes across X, Y, Z: distinguishable if combs overlap
COMBS = ((0.85, 0.3, 0.05), (0.15, 0.55, 0.1), (0.1, 0.35, 0.85))

_PULL = 1e-3  # relative offset towards the eye, without which surface and lines would mix


def surface_of(target: Object, depsgraph: bpy.types.Depsgraph, smooth: bool = False) -> Drawn:
    """`target` as displayed, with modifiers and edits; `smooth`: as if it had no sharp edges."""
    evaluated = target.evaluated_get(depsgraph)
    mesh: Any = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        positions = column(mesh.vertices, "co", width=3)
        corners = column(mesh.loops, "vertex_index", np.int32)
        normals = _corner_normals(mesh, corners, smooth)
        triangles = column(mesh.loop_triangles, "loops", np.int32, 3)
    finally:
        evaluated.to_mesh_clear()
    return drawn(positions, corners, normals, triangles)


def _corner_normals(mesh: Any, corners: np.ndarray, smooth: bool) -> np.ndarray:
    """(c, 3) float32."""
    if smooth and not column(mesh.polygons, "use_smooth", bool).all():
        return column(mesh.vertex_normals, "vector", width=3)[corners]
    return column(mesh.corner_normals, "vector", width=3)


def lines_of(surface: Drawn, settings: Any) -> list[tuple[np.ndarray, tuple[float, ...]]]:
    """Points (s, 3), two a line, and colour, of sections and combs; each axis has its own scale."""
    low, high = (getattr(surface.points, end)(axis=0, initial=0.0) for end in ("min", "max"))
    diagonal = float(np.linalg.norm(high - low))
    curves, over = [], []
    for axis, name in enumerate("XYZ"):
        if name not in settings.section_axes:
            continue
        found = sections(surface, axis, settings.section_count)
        curves += [section.curve for section in found]
        if settings.show_combs:
            ends = combs(found, diagonal, settings.comb_scale)
            over += [
                (teeth(found, ends), (*COMBS[axis], 0.5)),
                (segments(ends), (*COMBS[axis], 1.0)),
            ]
    return [line for line in [(segments(curves), CURVE), *over] if len(line[0])]


def pulled(projection: np.ndarray, distance: float) -> np.ndarray:
    """The projection, a little nearer to the eye, which is at `distance`."""
    pull = np.eye(4)
    if projection[3, 3] == 0.0:  # perspective: along the ray
        pull[:3, :3] *= 1.0 - _PULL
    else:
        pull[2, 3] = _PULL * distance
    return projection @ pull
