# SPDX-License-Identifier: GPL-3.0-or-later
"""Each function of the package that computes, on a small mesh: what all of them promise is tested once."""

import control_meshes as meshes
import discrete_fairing as df
import numpy as np
from scans import blob_cage, blob_scan
from sliver_meshes import stretched


def _rough(mesh, size):
    points, faces = mesh
    return points + size * np.random.default_rng(2).normal(size=points.shape), faces


ROUGH = _rough(meshes.torus(24, 16), 0.02)
OPEN = ROUGH[0], np.delete(ROUGH[1], [40, 41, 56, 57, 200], axis=0)
BALL = _rough(meshes.refine_triangles(*meshes.icosahedron()), 0.05)
NORMALS = np.where(np.arange(len(BALL[0]))[:, None] % 3, BALL[0], np.nan)
CAGE, SCAN = blob_cage(6, off=0.02), blob_scan(4000, 0.004)


def _moved(energy, **given):
    """What a solver makes of vertices that have gone elsewhere."""
    solver = df.Solver(*ROUGH, 2, energy, threads=given.pop("threads", 0))
    solver.solve()
    return solver.solve(ROUGH[0] + 0.01 * np.sin(9 * ROUGH[0]), **given)


CALLS = {
    "clean": lambda **given: df.clean(*OPEN, **given),
    "ease": lambda **given: df.ease(*ROUGH, **given),
    "fill_holes": lambda **given: df.fill_holes(*OPEN, **given),
    "fit": lambda **given: df.fit(*CAGE, SCAN, **given),
    "fit_patches": lambda **given: df.fit_patches(
        *meshes.random_hull(12), levels=4, force=True, **given
    ),
    "normals": lambda **given: df.fair(*BALL, 3, normals=NORMALS, **given),
    "shapes": lambda **given: df.fair(
        *BALL, 3, shapes=[BALL[0] * [1, 1, k] for k in (2, 3)], **given
    ),
    "solver": lambda **given: _moved("thin_plate", **given),
    "solver by steps": lambda **given: _moved("total_curvature", **given),
    "strain": lambda **given: df.strain(*ROUGH, **given),
    "thin faces": lambda **given: df.fair(*stretched(meshes.random_hull(400), 100), 3, **given),
}
