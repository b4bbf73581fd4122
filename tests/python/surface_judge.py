# SPDX-License-Identifier: GPL-3.0-or-later
"""Is a refined surface sound beside its control mesh, and beside the one on point forces? Plain
NumPy, and nothing of the core's."""

from dataclasses import dataclass

import numpy as np
import surface_measures as measures

SHARP = 90.0  # degrees
ROUNDING = 1e-3  # degrees: a square corner is not sharp


@dataclass
class Figures:
    """What is measured of one surface."""

    energy: float  # the integral of k1^2 + k2^2 over 8 pi, by cotangents
    angle: float  # degrees: 99.9 % of the dihedral angles are below
    largest_angle: float
    folds: int  # angles over 90 degrees and over all of the control mesh
    extent: float  # farthest point from the middle of the control mesh's box, over that of the mesh


def reach(points: np.ndarray, middle: np.ndarray) -> float:
    """The largest distance of a point from the middle."""
    return float(np.linalg.norm(points - middle, axis=1).max())


def triangles_of(faces) -> np.ndarray:
    """Polygons as fans."""
    fans = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    return np.array(fans, np.int64).reshape(-1, 3)


def judge(vertices: np.ndarray, faces, result) -> Figures:
    """The figures of a result of df.fair for a control mesh (vertices, faces)."""
    points = result.vertices
    angles = measures.dihedrals(points, result.triangles.astype(np.int64))
    middle = (vertices.min(0) + vertices.max(0)) / 2
    sharpest = measures.largest_dihedral(vertices, triangles_of(faces))
    return Figures(
        energy=measures.total_curvature_of_faces(points, *result.faces) / (8 * np.pi),
        angle=float(np.quantile(angles, 0.999)),
        largest_angle=float(angles.max()),
        folds=int((angles > max(SHARP, sharpest) + ROUNDING).sum()),
        extent=reach(points, middle) / reach(vertices, middle),
    )
