# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes inscribed in the unit sphere, which is their surface of least curvature."""

import control_meshes as meshes
import numpy as np


def pyramid():
    """Half an octahedron, Johnson's first solid."""
    points = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    return points, [[4, 2, 3], [4, 0, 2], [2, 1, 3], [2, 0, 1], [3, 1, 0, 4]]


def cube(cut: int = 0):
    """A cube of quads (0), or of triangles: diagonals in a row (1), or a tetrahedron's (2)."""
    points, quads = meshes.cube()
    if cut == 2:
        even = (points > 0).sum(1) % 2 == 0
        quads = np.array([np.roll(q, -int(not even[q[0]])) for q in quads])
    return points / 3**0.5, meshes.cut_quads((points, quads))[1] if cut else quads


SOLIDS = {
    "icosahedron": meshes.icosahedron,
    "octahedron": meshes.octahedron,
    "tetrahedron": meshes.tetrahedron,
    "cube": cube,
    "cube_cut": lambda: cube(1),
    "cube_cut_evenly": lambda: cube(2),
    "dodecahedron": meshes.dodecahedron,
    "J1": pyramid,
}
