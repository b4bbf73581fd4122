# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces between rows of vertices. Benchmarks have a `control_meshes` of their own, so this module imports none."""

import numpy as np


def lattice_faces(rows: int, columns: int, closed=(False, False)) -> np.ndarray:
    """Quads of rows of vertices; `closed`: whether rows and columns join their first ones."""
    at = np.arange(rows * columns).reshape(rows, columns)
    at = np.pad(at, [(0, int(each)) for each in closed], mode="wrap")
    return np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4)
