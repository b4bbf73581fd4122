# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of a mesh in the world: its coordinates times its object's scale, including parents.

Energies depend on the shape, so a mesh whose object is scaled unevenly is faired as displayed, and
Apply Scale changes nothing. Rotation and location have no effect and are left out.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..blender import Object
from ..core import ControlArrays

_DIGITS = 6  # significant digits, since matrices of objects are single precision


@dataclass(frozen=True)
class WorldShape:
    """The stretch from an object's coordinates to the shape in the world, in scene units."""

    # rows of a symmetric (3, 3) matrix; None: no stretch
    rows: tuple[tuple[float, ...], ...] | None

    @property
    def _matrix(self) -> np.ndarray:
        return np.array(self.rows)

    @property
    def way_back(self) -> np.ndarray:
        """(4, 4): from the world's shape to the coordinates of the object."""
        matrix = np.eye(4)
        if self.rows is not None:
            matrix[:3, :3] = np.linalg.inv(self._matrix)
        return matrix

    def of_arrays(self, arrays: ControlArrays) -> ControlArrays:
        """`arrays` with their positions and normals in the world's shape."""
        normals = arrays.normals
        if normals is not None and self.rows is not None:
            normals = _times(normals.astype(np.float64), np.linalg.inv(self._matrix))
        return replace(arrays, positions=self.of(arrays.positions), normals=normals)

    def of(self, positions: np.ndarray) -> np.ndarray:
        """(…, 3) object coordinates → the world's shape."""
        return positions if self.rows is None else _times(positions, self._matrix)

    def back(self, vertices: np.ndarray, sent: np.ndarray, own: np.ndarray) -> np.ndarray:
        """(N, 3) shape → object; first vertices `sent` from `own` return to the bit if unmoved."""
        if self.rows is None:
            return vertices
        found = _times(vertices, np.linalg.inv(self._matrix))
        stayed = np.flatnonzero((vertices[: len(sent)] == sent).all(axis=1))
        found[stayed] = own[stayed]
        return found


def world_shape(source: Object) -> WorldShape:
    """The WorldShape of a mesh object now, even if Blender has not updated it yet."""
    linear = np.array(world_matrix(source))[:3, :3].astype(np.float64)
    if not np.isfinite(linear).all():
        return WorldShape(None)
    # of its polar decomposition; the rotation is dropped
    squares, axes = np.linalg.eigh(linear.T @ linear)
    stretch = (axes * np.sqrt(np.maximum(squares, 0.0))) @ axes.T
    largest = float(np.abs(stretch).max())
    if squares[0] <= 1e-12 * squares[2]:
        return WorldShape(None)  # flat: not invertible
    stretch[np.abs(stretch) < 10.0**-_DIGITS * largest] = 0.0  # so that mirror images stay exact
    rows = tuple(tuple(float(f"{v:.{_DIGITS}g}") for v in row) for row in stretch)
    return WorldShape(None if rows == ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)) else rows)


def world_matrix(source: Object) -> Any:
    """The matrix from the object's own properties where possible: hidden ones are not updated."""
    if source.constraints or (source.parent is not None and source.parent_type != "OBJECT"):
        return source.matrix_world
    if source.parent is None:
        return source.matrix_basis
    above: Any = source.parent
    return world_matrix(above) @ source.matrix_parent_inverse @ source.matrix_basis


def matrix_relative_to(base: Object, matrix: Any) -> np.ndarray:
    """A (4, 4) matrix to the world, relative to the object `base`, which may be scaled to zero."""
    back = np.linalg.pinv(np.array(world_matrix(base), np.float64))
    return back @ np.array(matrix, np.float64)


def transformed(positions: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(…, 3) positions transformed by a (4, 4) matrix."""
    return positions @ matrix[:3, :3].T + matrix[:3, 3]


def _times(positions: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    diagonal = np.diagonal(matrix)
    if np.array_equal(matrix, np.diag(diagonal)):
        return positions * diagonal  # keeps mirror images, bit for bit
    return positions @ matrix
