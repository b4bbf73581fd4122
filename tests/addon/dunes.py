# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet of quads with one vertex out of line, for tests of strain and easing."""

import numpy as np
from lattices import lattice_faces
from scenes import add

ROWS, COLUMNS = 9, 7
FACES = lattice_faces(ROWS, COLUMNS)
WRONG, OFF = 31, 0.1  # the vertex that is out of line, and by how much, upwards


def dune(wrong=(WRONG,), off=OFF):
    """Vertices of a smooth sheet of unit edges about, some of which are `off` along z."""
    x, y = np.meshgrid(np.linspace(0, 8, ROWS), np.linspace(0, 6, COLUMNS), indexing="ij")
    points = np.stack([x, y, 0.4 * np.sin(0.5 * x) * np.cos(0.4 * y)], axis=2).reshape(-1, 3)
    points[list(wrong), 2] += off
    return points


def add_dune(**changed):
    return add("Dune", dune(**changed).tolist(), FACES.tolist())
