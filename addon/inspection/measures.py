# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the read-out: plain arrays, no Blender."""

import numpy as np

from .curvature import curvature
from .polygons import face_normals, faces_of_edges, uses


def measure(arrays):
    """What can be said of one mesh (see polygons) in numbers, as plain floats and ints; angles in degrees.

    Curvature is left out at borders and edges marked sharp, where it is not defined.
    """
    bent = curvature(arrays)
    worst, worst_any = worst_folds(arrays)
    return {
        "vertices": len(arrays.positions),
        "faces": len(arrays.offsets) - 1,
        "area": float(bent.area.sum()),
        "total_curvature": total_curvature(bent),
        "largest_curvature": float(bent.largest[bent.inner].max(initial=0.0)),
        "curvature_98": percentiles(bent.largest[bent.inner], 98.0)[0],
        "worst_fold": worst,
        "worst_fold_with_sharp": worst_any,
    }


def total_curvature(bent):
    """∫ κ₁² + κ₂² as a sum over the vertices where it is measured."""
    return float((bent.total * bent.area)[bent.inner].sum())


def worst_folds(arrays):
    """The largest angles between two faces that share an edge, in degrees: (over smooth edges, over all edges)."""
    angles, inside = fold_angles(arrays)
    smooth = inside if arrays.sharp_edge is None else inside & ~arrays.sharp_edge
    return float(angles[smooth].max(initial=0.0)), float(angles[inside].max(initial=0.0))


def fold_angles(arrays):
    """(e,) angles in degrees between the normals of each edge's two faces, and (e,) bool where there are two.

    Two faces that run the wrong way round along their edge are compared as if one were turned over.
    """
    normals = face_normals(arrays.positions, arrays.corners, arrays.offsets)
    pair = faces_of_edges(arrays)
    if not len(normals):
        return np.zeros(len(pair)), np.zeros(len(pair), bool)
    first, second = normals[pair[:, 0]], normals[pair[:, 1]]
    second = second * np.where(_same_way(arrays), -1.0, 1.0)[:, None]
    # from the lengths of sum and difference: arccos would lose half its digits near 0°
    apart = np.linalg.norm(first - second, axis=1)
    together = np.linalg.norm(first + second, axis=1)
    has_area = (normals != 0.0).any(axis=1)
    inside = (uses(arrays) == 2) & has_area[pair].all(axis=1)
    return np.degrees(2.0 * np.arctan2(apart, together)), inside


def percentiles(values, *ranks):
    """Floats at the `ranks` (0 to 100) of the finite `values`; zeros if there are none."""
    values = values[np.isfinite(values)]
    return [float(v) for v in np.percentile(values, ranks)] if len(values) else [0.0] * len(ranks)


def largest_deviation(control, result):
    """How far the first vertices of `result` (N, 3), which stand for those of `control` (n, 3), are from them; None if fewer."""
    if len(result) < len(control) or not len(control):
        return None
    return float(np.linalg.norm(result[: len(control)] - control, axis=1).max())


def _same_way(arrays):
    """(e,) bool: edges that their faces run along in the same direction."""
    forward = arrays.edges[arrays.corner_edges, 0] == arrays.corners
    total = np.bincount(arrays.corner_edges, weights=forward, minlength=len(arrays.edges))
    return total != 1
