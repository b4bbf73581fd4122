# SPDX-License-Identifier: GPL-3.0-or-later
"""Tries an installed wheel: fairs an octahedron, and fails if the result is not what it has to be."""

import discrete_fairing as df
import numpy as np

vertices = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)
faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]

result = df.fair(vertices, faces, levels=3)
energy = result.report["energy"]
assert np.array_equal(result.vertices[:6], vertices), "the control vertices are interpolated"
assert np.isfinite(result.vertices).all()
assert energy["result"]["thin_plate"] < energy["polyhedron"]["thin_plate"]
print(f"discrete_fairing {df.__version__} fairs an octahedron: {result}")
