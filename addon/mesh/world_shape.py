# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape that a mesh has in the world: what its object's scale makes of it, parents included.

Energies are those of a shape, so a mesh whose object is scaled unevenly is faired as it is seen, and
Apply Scale changes nothing. Rotation and place do not matter and are left out.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..blender import Object
from ..core import ControlArrays

_DIGITS = 6  # significant ones: matrices of objects are in single precision


@dataclass(frozen=True)
class WorldShape:
    """The stretch from an object's coordinates to the shape in the world, in scene units."""

    rows: tuple[tuple[float, ...], ...] | None  # of a symmetric (3, 3) matrix; None: there is none

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
        """(…, 3) of the object → of the world's shape."""
        return positions if self.rows is None else _times(positions, self._matrix)

    def back(self, vertices: np.ndarray, sent: np.ndarray, own: np.ndarray) -> np.ndarray:
        """(N, 3) of the world's shape → of the object.

        The first of them were `sent`, which the object has as `own`: those that have not moved come
        back to the bit.
        """
        if self.rows is None:
            return vertices
        found = _times(vertices, np.linalg.inv(self._matrix))
        stayed = np.flatnonzero((vertices[: len(sent)] == sent).all(axis=1))
        found[stayed] = own[stayed]
        return found


def world_shape(source: Object) -> WorldShape:
    """The WorldShape of a mesh object as it is now, whether Blender has looked at it since or not."""
    linear = np.array(world_matrix(source))[:3, :3].astype(np.float64)
    if not np.isfinite(linear).all():
        return WorldShape(None)
    # of its polar decomposition: the rotation is dropped
    squares, axes = np.linalg.eigh(linear.T @ linear)
    stretch = (axes * np.sqrt(np.maximum(squares, 0.0))) @ axes.T
    largest = float(np.abs(stretch).max())
    if squares[0] <= 1e-12 * squares[2]:
        return WorldShape(None)  # flat: nothing leads back
    stretch[np.abs(stretch) < 10.0**-_DIGITS * largest] = 0.0  # so that mirrors stay mirrors
    rows = tuple(tuple(float(f"{v:.{_DIGITS}g}") for v in row) for row in stretch)
    return WorldShape(None if rows == ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)) else rows)


def world_matrix(source: Object) -> Any:
    """By its own properties where these say it: Blender does not look at hidden objects."""
    if source.constraints or (source.parent is not None and source.parent_type != "OBJECT"):
        return source.matrix_world
    if source.parent is None:
        return source.matrix_basis
    above: Any = source.parent
    return world_matrix(above) @ source.matrix_parent_inverse @ source.matrix_basis


def transformed(positions: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(…, 3), moved by a (4, 4) matrix."""
    return positions @ matrix[:3, :3].T + matrix[:3, 3]


def _times(positions: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    diagonal = np.diagonal(matrix)
    if np.array_equal(matrix, np.diag(diagonal)):
        return positions * diagonal  # which keeps mirror images, bit for bit
    return positions @ matrix
