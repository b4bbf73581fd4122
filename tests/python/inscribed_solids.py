# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes with all vertices on the unit sphere, written as numbers or made as hulls. Their surface of least
total curvature is the sphere."""

import control_meshes as meshes
import numpy as np


def pyramid():
    """Half an octahedron, Johnson's first solid."""
    points = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    return points, [[4, 2, 3], [4, 0, 2], [2, 1, 3], [2, 0, 1], [3, 1, 0, 4]]


def cube(cut: int = 0):
    """A cube of quads (0), or of triangles: by diagonals that follow each other (1), by the six edges of a
    tetrahedron (2)."""
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
